#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tegotae/core/ids.hpp"
#include "tegotae/loop/scene.hpp"

namespace tegotae {

/// Index of the held part among the scene's. Throws Error unless exactly one is held.
std::size_t held_number(const Scene& scene);
inline const Part& held_part(const Scene& scene) {
  return scene.parts[held_number(scene)];
}
inline Part& held_part(Scene& scene) {
  return scene.parts[held_number(scene)];
}

/// The held part and the fixed ones, in the order of their numbers.
struct SceneParts {
  const Part* held = nullptr;
  std::vector<const Part*> fixed;
  std::vector<PartId> fixed_id;  ///< of each fixed part
  explicit SceneParts(const Scene& scene);
};

/// Names of all parts, in their order.
std::vector<std::string> part_names(const Scene& scene);

/// What of a scene's meshes is not as their files say, "MESH: what", once for each mesh.
std::vector<std::string> notes_of(const Scene& scene);

}  // namespace tegotae
