#include "cli/view_command.hpp"

#include "import/file_check.hpp"
#include "review/review_command.hpp"
#include "view/replay.hpp"

namespace tegotae::apps {

CLI::App* add_view(CLI::App& app, ViewOptions& options) {
  CLI::App* view = app.add_subcommand("view", "Look at a scene, an assembly, a mesh or a recording in a page");
  view->add_option("FILE", options.open.file,
                   "Scene (.toml), STEP, glTF, 3MF, STL, OBJ, PLY, OFF, recording (.csv, .mcap)")
      ->required();
  view->add_option("--hold", options.open.hold, "Name of the part to hold (the scene's, or the smallest)")
      ->type_name("NAME");
  add_unit_option(*view, options.open.import);
  add_page_options(*view, options.run.page);
  options.run.view = true;
  return view;
}

int view_file(const ViewOptions& options, const MeshLoader& load) {
  const std::string& name = options.open.file;
  const std::string ending = lower_extension(name);
  if (ending == ".csv" || ending == ".mcap") return show_recording(name, "", "", options.run.page);
  OpenOptions open = options.open;
  open.held_needed = false;
  return with_scene(open, load, [&](SceneFile file) {
    file.scene.contact.initial_overlap = InitialOverlap::ignore;  // the page says which parts overlap
    return run_and_report(std::move(file), options.run, name);
  });
}

int show_recording(const std::string& recording, const std::string& scene, const std::string& html,
                   const PageOptions& page) {
  const std::string bundle = view::replay_bundle(recording, scene, html);
  if (html.empty())
    view::serve_replay(
        bundle, [&] { return review::recording_report(recording, scene); }, page_address(page), catch_interrupts(),
        [&](const view::Server& server) { announce_page(server, page); });
  else
    view::write_replay(bundle, html);
  return kDone;
}

}  // namespace tegotae::apps
