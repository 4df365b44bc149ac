#pragma once

#include <limits>

namespace tegotae {

/// Counts the ticks in which a part moves under a still pen and comes no nearer to it than it has been: it swings, to
/// and fro between places that are the same ones again and again.
class Swings {
 public:
  /// After each tick, which leaves a squared error of `left`. Less by a `share` of it counts as nearer.
  void add(double left, double share, bool moved) noexcept {
    if (left < (1 - share) * least_)
      least_ = left;
    else if (moved)
      ++ticks_;
  }
  void forget() noexcept { *this = {}; }
  int ticks() const noexcept { return ticks_; }

 private:
  double least_ = std::numeric_limits<double>::infinity();
  int ticks_ = 0;
};

}  // namespace tegotae
