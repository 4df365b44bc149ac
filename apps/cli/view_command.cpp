#include "cli/view_command.hpp"

#include <algorithm>
#include <iostream>

#include "import/file_check.hpp"
#include "review/review_command.hpp"
#include "shared/option_check.hpp"
#include "shared/status_line.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::apps {
namespace {

/// Where no part is held one looks, until the page takes one.
void note_nothing_held(const SceneFile& file, const RunOptions& run) {
  const auto& parts = file.scene.parts;
  if (std::any_of(parts.begin(), parts.end(), [](const Part& p) { return p.held; })) return;
  if (!run.guide.empty()) throw Error("--guide leads a held part: name the one that the path is of with --hold NAME");
  std::cout << "Nothing is held: pick a part in the page and press Hold" << std::endl;
}

}  // namespace

CLI::App* add_view(CLI::App& app, ViewOptions& options) {
  CLI::App* view = app.add_subcommand("view", "Look at a scene, an assembly, a mesh or a recording in a page");
  view->add_option("FILE", options.open.file,
                   "Scene (.toml), STEP, glTF, 3MF, STL, OBJ, PLY, OFF, recording (.csv, .mcap)")
      ->required();
  view->add_option("--hold", options.open.hold,
                   "Name of the part to hold (the scene's; where it has none, the page takes one)")
      ->type_name("NAME");
  add_unit_option(*view, options.open.import);
  add_guide_option(*view, options.run);
  add_page_options(*view, options.run.page);
  options.run.view = true;
  return view;
}

int view_file(const ViewOptions& options, const MeshLoader& load) {
  const std::string& name = options.open.file;
  const std::string ending = lower_extension(name);
  if (ending == ".csv" || ending == ".mcap") {
    ReplayOptions replay;
    replay.recording = name;
    replay.page = options.run.page;
    replay.load = load;
    return show_recording(replay);
  }
  OpenOptions open = options.open;
  open.held_needed = false;
  return with_scene(open, load, [&](SceneFile file) {
    file.scene.contact.initial_overlap = InitialOverlap::ignore;  // the page says which parts overlap
    note_nothing_held(file, options.run);
    return run_and_report(std::move(file), options.run, name);
  });
}

CLI::App* add_replay(CLI::App& app, ReplayOptions& options) {
  CLI::App* replay = app.add_subcommand("replay", "Serve a page that shows a recording, until Ctrl-C");
  replay->add_option("RECORDING", options.recording, "What --record wrote")->required();
  replay->add_option("SCENE", options.scene, "Its scene file (the one that the recording names)");
  CLI::Option* file =
      replay->add_option("--html", options.html, "Write the page to a file that needs no server, then exit")
          ->type_name("FILE");
  replay->add_option("--frames", options.frames, "That the page gets at most; fewer make a smaller file")
      ->check(between(std::size_t{2}, view::kMaxFrames))
      ->capture_default_str()
      ->type_name("N");
  const PageOptionNames page = add_page_options(*replay, options.page);
  page.address->excludes(file);
  page.no_browser->excludes(file);
  return replay;
}

int show_recording(const ReplayOptions& options) {
  std::string bundle;
  {
    StatusLine status;
    bundle = view::replay_bundle(
        options.recording, options.scene, options.html, options.frames,
        [&](const char* what, std::size_t done, std::size_t total) { status.show(what, done, total); }, options.load);
  }
  if (options.html.empty())
    view::serve_replay(
        bundle, [&] { return review::recording_report(options.recording, options.scene, options.load); },
        page_address(options.page), catch_interrupts(),
        [&](const view::Server& server) { announce_page(server, options.page); });
  else
    view::write_replay(bundle, options.html);
  return kDone;
}

}  // namespace tegotae::apps
