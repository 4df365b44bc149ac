#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tegotae/sim/scene.hpp"

namespace tegotae {

/// Keeps the poses that a run committed and asks FCL about each of them afterwards, independently of the loop that
/// committed them.
class PoseCheck {
 public:
  /// Poses kept; of more, every second, fourth, ... one: a check takes seconds, not minutes.
  static constexpr std::size_t kMost = 20000;

  PoseCheck() { poses_.reserve(kMost); }

  /// Never allocates. A pose equal to the last one counts once.
  void add(const Pose& X) noexcept;
  /// How many of the kept poses intersect a fixed part of `scene`.
  std::int64_t count_intersecting(const Scene& scene) const;

 private:
  std::vector<Pose> poses_;
  std::size_t stride_ = 1;
  std::size_t seen_ = 0;
  Pose last_;
};

}  // namespace tegotae
