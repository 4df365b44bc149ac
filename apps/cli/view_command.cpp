#include "cli/view_command.hpp"

#include <algorithm>
#include <iostream>

#include "import/file_check.hpp"
#include "review/review_command.hpp"
#include "shared/status_line.hpp"
#include "shared/temporary_folder.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/mesh/report.hpp"
#include "view/replay.hpp"

namespace tegotae::apps {
namespace {

/// A page is looked at before anybody knows what to hold: the smallest part is most often what goes into another.
std::string smallest_part(const Scene& scene) {
  const Part* smallest = nullptr;
  double size = 0;
  for (const Part& part : scene.parts) {
    const MeshReport known = report(*part.mesh);
    const double diagonal = (known.box_max - known.box_min).norm();
    if (smallest != nullptr && diagonal >= size) continue;
    smallest = &part;
    size = diagonal;
  }
  return smallest != nullptr ? smallest->name : "";
}

int view_scene(const std::string& path, const ViewOptions& options, const MeshLoader& load) {
  SceneFile file = load_with_progress(path, {options.hold, false, {}, load});
  print_notes(file.scene);
  auto& parts = file.scene.parts;
  if (std::none_of(parts.begin(), parts.end(), [](const Part& p) { return p.held; })) {
    const std::string name = smallest_part(file.scene);
    for (Part& part : parts) part.held = part.name == name;
    const auto held = std::find_if(parts.begin(), parts.end(), [](const Part& p) { return p.held; });
    file.script = StylusScript({{0, held->pose}});
    std::cout << "In the hand is " << name << "; take another one in the page, or with --hold NAME" << std::endl;
  }
  // Parts of an assembly as people have them overlap here and there; the page says which.
  file.scene.contact.initial_overlap = InitialOverlap::ignore;
  return run_and_report(std::move(file), options.run, options.file);
}

}  // namespace

CLI::App* add_view(CLI::App& app, ViewOptions& options) {
  CLI::App* view = app.add_subcommand("view", "Look at a scene, an assembly, a mesh or a recording in a page");
  view->add_option("FILE", options.file, "Scene (.toml), STEP, glTF, 3MF, STL, OBJ, PLY, OFF, recording (.csv, .mcap)")
      ->required();
  view->add_option("--hold", options.hold, "Name of the part to hold (the scene's, or the smallest)")
      ->type_name("NAME");
  view->add_option("--unit", options.import.assembly.unit,
                   "Unit of a file that does not tell it: m (default), cm, mm, um, in")
      ->check(CLI::IsMember({"m", "cm", "mm", "um", "in"}))
      ->type_name("UNIT");
  add_guide_option(*view, options.run);
  add_page_options(*view, options.run.page);
  options.run.view = true;
  return view;
}

int view_file(const ViewOptions& options, const MeshLoader& load) {
  const std::string ending = lower_extension(options.file);
  if (ending == ".csv" || ending == ".mcap") return show_recording(options.file, "", "", options.run.page);
  if (ending == ".toml") return view_scene(options.file, options, load);
  const TemporaryFolder folder;
  ImportOptions import = options.import;
  import.file = options.file;
  import.folder = folder.path().string();
  import.hold = options.hold;
  import.quiet = true;
  if (const int code = import_file(import); code != kDone) return code;
  return view_scene((folder.path() / "scene.toml").string(), options, load);
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
