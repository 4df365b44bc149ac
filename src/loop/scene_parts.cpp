#include "loop/scene_parts.hpp"

#include <set>

#include "tegotae/core/error.hpp"

namespace tegotae {

std::size_t held_number(const Scene& scene) {
  const Part* held = nullptr;
  for (const Part& p : scene.parts) {
    if (!p.held) continue;
    if (held != nullptr)
      throw Error(ErrorKind::setting,
                  "parts \"" + held->name + "\" and \"" + p.name + "\" are both held; exactly one may be",
                  {{}, 0, "part.held", p.name});
    held = &p;
  }
  if (held == nullptr)
    throw Error(ErrorKind::setting, "no part is held; exactly one must be", {{}, 0, "part.held", {}});
  return static_cast<std::size_t>(held - scene.parts.data());
}

SceneParts::SceneParts(const Scene& scene) : held(&held_part(scene)) {
  for (std::uint32_t i = 0; i < scene.parts.size(); ++i) {
    if (scene.parts[i].held) continue;
    fixed.push_back(&scene.parts[i]);
    fixed_id.push_back({i});
  }
}

std::vector<std::string> part_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const Part& part : scene.parts) names.push_back(part.name);
  return names;
}

std::vector<std::string> notes_of(const Scene& scene) {
  std::vector<std::string> notes;
  std::set<const TriangleMesh*> seen;
  for (const Part& part : scene.parts) {
    if (!seen.insert(part.mesh.get()).second) continue;
    for (const std::string& note : part.mesh->notes) notes.push_back(part.mesh->name + ": " + note);
  }
  return notes;
}

}  // namespace tegotae
