#include "cli/open_scene.hpp"

#include <algorithm>
#include <iostream>
#include <optional>

#include "import/file_check.hpp"
#include "shared/option_check.hpp"
#include "shared/run_options.hpp"
#include "shared/status_line.hpp"
#include "shared/temporary_folder.hpp"
#include "tegotae/mesh/report.hpp"

namespace tegotae::apps {
namespace {

/// Nobody has said what to hold: the smallest part is most often what goes into another.
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

void hold_smallest(SceneFile& file, bool quiet) {
  auto& parts = file.scene.parts;
  const auto is_held = [](const Part& p) { return p.held; };
  if (std::any_of(parts.begin(), parts.end(), is_held)) return;
  std::string name;
  {
    StatusLine status(!quiet);
    status.say("looking for the smallest part");
    name = smallest_part(file.scene);
  }
  for (Part& part : parts) part.held = part.name == name;
  const auto held = std::find_if(parts.begin(), parts.end(), is_held);
  file.script = StylusScript({{0, held->pose}});
  (quiet ? std::cerr : std::cout) << "The hand holds " << name << "; --hold NAME takes another one" << std::endl;
}

}  // namespace

void add_unit_option(CLI::App& app, ImportOptions& options) {
  app.add_option("--unit", options.assembly.unit,
                 "Unit of an STL, OBJ, PLY, OFF or glTF file: m, cm, mm, um, in (m; asked for beyond 20 m)")
      ->check(one_of({"m", "cm", "mm", "um", "in"}))
      ->type_name("UNIT");
}

int with_scene(const OpenOptions& options, const MeshLoader& load, const std::function<int(SceneFile)>& then) {
  require_file(options.file);
  const bool of_parts = is_file_of_parts(options.file);
  std::optional<TemporaryFolder> folder;
  std::string path = options.file;
  if (of_parts) {
    folder.emplace();
    ImportOptions import = options.import;
    import.file = options.file;
    import.folder = folder->path().string();
    import.hold = options.hold;
    import.quiet = true;
    if (const int code = import_file(import); code != kDone) return code;
    path = (folder->path() / "scene.toml").string();
  }
  const SceneOptions how{options.hold, options.held_needed && !of_parts, {}, load};
  SceneFile file = load_with_progress(path, how, !options.quiet);
  print_notes(file.scene);
  if (of_parts && options.held_needed) hold_smallest(file, options.quiet);
  // Parts of an assembly as people have them overlap here and there; what is told at the start names them.
  if (of_parts) file.scene.contact.initial_overlap = InitialOverlap::ignore;
  if (of_parts) file.path = options.file;  // the scene made of it is nothing that anybody has named
  return then(std::move(file));
}

}  // namespace tegotae::apps
