#include "sim/scene_parts.hpp"

#include "tegotae/core/error.hpp"

namespace tegotae {

std::size_t held_number(const Scene& scene) {
  const Part* held = nullptr;
  for (const Part& p : scene.parts) {
    if (!p.held) continue;
    if (held != nullptr)
      throw Error("parts \"" + held->name + "\" and \"" + p.name + "\" are both held; exactly one may be");
    held = &p;
  }
  if (held == nullptr) throw Error("no part is held; exactly one must be");
  return static_cast<std::size_t>(held - scene.parts.data());
}

SceneParts::SceneParts(const Scene& scene) : held(&held_part(scene)) {
  for (const Part& p : scene.parts)
    if (!p.held) fixed.push_back(&p);
}

}  // namespace tegotae
