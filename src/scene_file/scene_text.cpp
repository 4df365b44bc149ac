#include "scene_file/scene_text.hpp"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "loop/scene_parts.hpp"
#include "scene_file/toml_table.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

namespace fs = std::filesystem;

bool same(const Pose& a, const Pose& b) {
  return a.p == b.p && a.q.coeffs() == b.q.coeffs();
}

const Part* find(const Scene& scene, const std::string& name) {
  const auto part = std::find_if(scene.parts.begin(), scene.parts.end(), [&](const Part& p) { return p.name == name; });
  return part == scene.parts.end() ? nullptr : &*part;
}

/// Makes the path under `key` one that is seen from `to` and not from `from`.
void move_path(toml::table& t, const char* key, const fs::path& from, const fs::path& to) {
  const auto path = t[key].value<std::string>();
  if (path) t.insert_or_assign(key, fs::proximate(fs::absolute(from / *path), fs::absolute(to / ".")).generic_string());
}

void set_pose(toml::table& t, const Pose& X) {
  t.erase("rpy_deg");
  t.insert_or_assign("position", toml::array{X.p.x(), X.p.y(), X.p.z()});
  t.insert_or_assign("orientation", toml::array{X.q.w(), X.q.x(), X.q.y(), X.q.z()});
}

/// Takes out friction of pairs of which one is gone: a file that names a part it does not have is refused.
void drop_pairs(toml::table& top, const Scene& now) {
  toml::array* pairs = top["friction"]["pair"].as_array();
  if (pairs == nullptr) return;
  for (std::size_t i = pairs->size(); i-- > 0;) {
    const toml::array& names = *(*pairs)[i].as_table()->get("parts")->as_array();
    const bool gone = std::any_of(names.begin(), names.end(), [&](const toml::node& name) {
      return find(now, *name.value<std::string>()) == nullptr;
    });
    if (gone) pairs->erase(pairs->begin() + static_cast<std::ptrdiff_t>(i));
  }
}

}  // namespace

std::string scene_settings(const SceneFile& file) {
  std::ostringstream out;
  if (!file.text.empty()) out << parse_toml(file.text, file.path);
  return out.str();
}

std::string scene_text(const SceneFile& file, const Scene& now, const std::string& folder) {
  if (file.text.empty()) throw Error("a scene that was not read from a file cannot be written to one");
  toml::table top = parse_toml(file.text, file.path);
  const fs::path from = fs::path(file.path).parent_path();
  toml::array& parts = *top["part"].as_array();
  for (std::size_t i = 0; i < parts.size();) {
    toml::table& t = *parts[i].as_table();
    const std::string name = *t["name"].value<std::string>();
    const Part* part = find(now, name);
    if (part == nullptr) {
      parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(i));
      continue;
    }
    move_path(t, "mesh", from, folder);
    if (!same(part->pose, find(file.scene, name)->pose)) set_pose(t, part->pose);
    t.erase("held");
    if (part->held) t.insert("held", true);
    ++i;
  }
  drop_pairs(top, now);
  if (toml::table* device = top["device"].as_table()) {
    move_path(*device, "script", from, folder);
    if (held_part(now).name != held_part(file.scene).name) device->erase("script");
  }
  // The command line may have named another one.
  if (top["contact"].as_table() == nullptr) top.insert("contact", toml::table());
  top["contact"].as_table()->insert_or_assign("resolver", to_string(now.contact.resolver));
  std::ostringstream out;
  out << top << "\n";
  return out.str();
}

}  // namespace tegotae
