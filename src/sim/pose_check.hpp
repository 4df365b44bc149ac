#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tegotae/sim/scene.hpp"
#include "tegotae/sim/start.hpp"

namespace tegotae {

/// Keeps the poses that a run committed and asks FCL about each of them afterwards, independently of the loop that
/// committed them.
class PoseCheck {
 public:
  /// Poses kept; of more, every second, fourth, ... one: a check takes seconds, not minutes.
  static constexpr std::size_t kMost = 20000;

  PoseCheck() { poses_.reserve(kMost); }

  /// Never allocates. A pose equal to the last one counts once. `freed`: how many pairs of StartReport had come free.
  void add(const Pose& X, std::uint32_t freed = 0) noexcept;
  /// No pose comes any more.
  void shrink() { poses_.shrink_to_fit(); }
  /// How many of the kept poses intersect a fixed part of `scene`, pairs left out that had not come free by then.
  /// `share` (may be null) is told how far that is, from 0 to 1.
  std::int64_t count_intersecting(const Scene& scene, const StartReport& start = {},
                                  std::atomic<double>* share = nullptr) const;

 private:
  struct Kept {
    Pose X;
    std::uint32_t freed;
  };
  std::vector<Kept> poses_;
  std::size_t stride_ = 1;
  std::size_t seen_ = 0;
  Pose last_;
};

}  // namespace tegotae
