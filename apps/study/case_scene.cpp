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

std::string write_case_scene(const SceneFile& file, const Case& c, const std::string& folder) {
  const std::filesystem::path to = folder;
  make_folder(folder);
  const std::string path = (to / "scene.toml").string();
  refuse_to_replace(path, file.files);
  toml::table top = parse_toml(scene_text(file, file.scene, folder), path);
  for (std::size_t i = 0; i < file.scene.parts.size(); ++i) {
    const Part& part = file.scene.parts[i];
    if (c.find("inward " + part.name) == nullptr) continue;
    const std::string mesh = "part-" + std::to_string(i + 1) + ".ply";
    write_ply(*part.mesh, (to / mesh).string(), 1);
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
