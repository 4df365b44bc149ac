#include "cli/import.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iostream>

#include "cli/open_scene.hpp"
#include "cli/scene_writer.hpp"
#include "core/name_list.hpp"
#include "core/number_text.hpp"
#include "shared/length_option.hpp"
#include "shared/option_check.hpp"
#include "shared/run_options.hpp"
#include "shared/status_line.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::apps {

namespace {

void require_part(const Assembly& assembly, const ImportOptions& options) {
  if (options.hold.empty()) return;
  const auto& parts = assembly.parts;
  if (std::any_of(parts.begin(), parts.end(), [&](const AssemblyPart& p) { return p.name == options.hold; })) return;
  std::vector<std::string> names;
  for (const AssemblyPart& part : parts) names.push_back(part.name);
  throw Error(options.file + ": no part is named " + options.hold + " (there are " + name_list(names) + ")");
}

std::string counted(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + ' ' + (n == 1 ? one : many);
}

/// What was made, and what to do with it. The size shows a wrong unit at once.
std::string result_text(const Assembly& assembly, const std::string& scene, bool hold_one) {
  std::size_t triangles = 0;
  Eigen::AlignedBox3d box;
  for (const AssemblyPart& part : assembly.parts) {
    const TriangleMesh& mesh = *assembly.shapes[part.shape];
    triangles += mesh.triangles.size();
    for (const Vec3& p : mesh.vertices) box.extend(part.pose * p);
  }
  const Vec3 mm = 1e3 * box.sizes();
  std::string text = scene + ": " + counted(assembly.parts.size(), "part", "parts") + ", " +
                     counted(assembly.shapes.size(), "mesh", "meshes") + ", " +
                     counted(triangles, "triangle", "triangles") + ", " + number_text(mm.x(), 4) + " x " +
                     number_text(mm.y(), 4) + " x " + number_text(mm.z(), 4) + " mm\n";
  text += "look at it and take parts with `tegotae view " + scene + "`\n";
  if (assembly.parts.size() > 1) text += "take it apart: `tegotae plan " + scene + " --all`\n";
  if (hold_one)
    text += "no part is held: `tegotae run " + scene + " --hold NAME` takes one, or give it held = true in the file\n";
  return text;
}

int import_here(const ImportOptions& options, const std::function<void(const std::string&)>& at) {
  const std::filesystem::path scene = std::filesystem::path(options.folder) / "scene.toml";
  if (std::filesystem::exists(scene))
    throw Error(scene.string() + ": exists already; remove it or choose another folder");
  AssemblyOptions reading = options.assembly;
  Assembly assembly;
  {
    StatusLine status;
    reading.progress = [&](const char* what, std::size_t done, std::size_t total) {
      at(what);
      status.show(what, done, total);
    };
    assembly = read_assembly(options.file, reading);
    require_part(assembly, options);
    write_scene(assembly, options.file, options.folder, options.hold, reading.progress);
  }
  for (const std::string& note : assembly.notes) std::cerr << "tegotae: note: " << note << "\n";
  if (options.quiet) return kDone;
  std::cout << result_text(assembly, scene.string(), options.hold.empty());
  return kDone;
}

}  // namespace

CLI::App* add_import(CLI::App& app, ImportOptions& options) {
  CLI::App* import = app.add_subcommand("import", "Turn an assembly (STEP, glTF, 3MF) or a mesh file into a scene");
  import->add_option("FILE", options.file, "STEP, glTF, GLB, 3MF; or STL, OBJ, PLY, OFF")->required();
  import->add_option("-o", options.folder, "Folder to write into; it gets scene.toml and meshes/")
      ->required()
      ->type_name("DIR");
  import->add_option("--hold", options.hold, "Name of the part to hold")->type_name("NAME");
  import->add_flag("--split", options.assembly.split, "Make a part of every connected piece of a surface");
  add_unit_option(*import, options);
  add_length_option(*import, "--chord", options.assembly.chord,
                    "STEP: how far facets may be from curved faces that mate (5um)");
  add_length_option(*import, "--coarse-chord", options.assembly.coarse_chord,
                    "STEP: how far they may be from other curved faces (50um); a part alone in its file is between the "
                    "two by its size");
  import->add_option("--seconds", options.bounds.seconds, "How long reading, or the facets of one part, may take (600)")
      ->check(between(1e-3, 1e6))
      ->type_name("S");
  import
      ->add_option("--megabytes", options.bounds.megabytes,
                   "How much memory reading may take (three quarters of the machine's)")
      ->check(between(1.0, 1e9))
      ->type_name("MB");
  return import;
}

int import_file(const ImportOptions& options) {
  const char* hint =
      "is its unit right? For fewer facets tegotae import has --chord and --coarse-chord, for more time --seconds";
  return watched_child(options.file, options.bounds, hint, [&](const auto& at) { return import_here(options, at); });
}

}  // namespace tegotae::apps
