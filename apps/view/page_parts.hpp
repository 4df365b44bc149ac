#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "tegotae/loop/scene.hpp"

namespace tegotae::view {

/// The parts of a run as a page knows them: by their numbers in the scene file, those that were taken out too.
class PageParts {
 public:
  explicit PageParts(const Scene& scene) : parts_(scene.parts), removed_(scene.parts.size()) {}

  /// Does what the page asks for: {do: hold | remove | add, part}, or {do: move, part, by: [x, y, z] (m),
  /// turn: [x, y, z]}: the latter about the part's middle and the world's axes, x first (rad). Throws Error when it
  /// makes no sense.
  void edit(const nlohmann::json& command);

  /// Those that are in the scene, and their numbers.
  std::vector<Part> in_scene() const;
  std::vector<std::uint32_t> numbers() const;
  /// Takes over where in_scene() came to be.
  void place(const std::vector<Part>& in_scene);

  const std::vector<Part>& all() const { return parts_; }
  bool removed(std::size_t part) const { return removed_[part]; }
  bool any_held() const { return held() < parts_.size(); }
  std::size_t held() const;  ///< the number of parts when none is
  /// Nothing is held any more; what was stays at `X`.
  void put_down(const Pose& X);

 private:
  std::vector<Part> parts_;
  std::vector<bool> removed_;
};

}  // namespace tegotae::view
