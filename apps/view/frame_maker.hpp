#pragma once

#include <vector>

#include "tegotae/sim/session.hpp"
#include "view/frame.hpp"

namespace tegotae::view {

/// Makes frames of ticks, without allocation.
class FrameMaker {
 public:
  explicit FrameMaker(const Scene& scene);

  /// Fills in what the loop knows: X, contacts, gap, pairs. Of more pairs than fit, those in contact come first.
  void add_loop(const HapticLoop& loop, Frame& frame) const;
  /// All of a running session's tick.
  void fill(const TickView& tick, Frame& frame) const;

 private:
  std::vector<std::uint32_t> fixed_;  // numbers of the fixed parts in the scene
};

}  // namespace tegotae::view
