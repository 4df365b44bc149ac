#include "study/case_scene.hpp"

#include <filesystem>
#include <sstream>

#include "core/output_file.hpp"
#include "core/same_file.hpp"
#include "scene_file/scene_text.hpp"
#include "scene_file/toml_table.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/import/write.hpp"

namespace tegotae::study {

namespace {

/// The mesh of part `i` in a case that has changed it; empty: it has not.
std::string changed_mesh(const SceneFile& file, const Case& c, std::size_t i) {
  if (c.find("inward " + file.scene.parts[i].name) == nullptr) return "";
  return "part-" + std::to_string(i + 1) + ".ply";
}

}  // namespace

std::string write_case_scene(const SceneFile& file, const Case& c, const std::string& folder,
                             const std::vector<std::string>& inputs) {
  const std::filesystem::path to = folder;
  make_folder(folder);
  const std::string path = (to / "scene.toml").string();
  std::vector<std::string> outputs = {path};
  for (std::size_t i = 0; i < file.scene.parts.size(); ++i)
    if (const std::string mesh = changed_mesh(file, c, i); !mesh.empty()) outputs.push_back((to / mesh).string());
  refuse_to_replace(outputs, inputs);
  toml::table top = parse_toml(scene_text(file, file.scene, folder), path);
  for (std::size_t i = 0; i < file.scene.parts.size(); ++i) {
    const std::string mesh = changed_mesh(file, c, i);
    if (mesh.empty()) continue;
    write_ply(*file.scene.parts[i].mesh, (to / mesh).string(), 1);
    toml::table& t = *top["part"].as_array()->get(i)->as_table();
    t.insert_or_assign("mesh", mesh);
    t.insert_or_assign("unit", "m");
  }
  if (const Value* mu = c.find("mu")) top.insert_or_assign("friction", toml::table{{"mu", mu->number}});
  std::ostringstream text;
  text << top << "\n";
  write_file(path, text.str());
  return path;
}

}  // namespace tegotae::study
