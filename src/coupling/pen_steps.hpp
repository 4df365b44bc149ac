#pragma once

#include <array>
#include <cstddef>

#include "tegotae/core/pose.hpp"
#include "tegotae/coupling/coupling.hpp"

namespace tegotae {

/// What of the energy that a sampled coupling seems to make comes from the steps of the pen's resolution alone. Held
/// over a tick, springs make ½ k Δx² of a pen that moves by Δx, and the damper, whose velocity is known to a step a
/// tick, up to d Δx² / T. A pen that is a step farther after N ticks has not moved by a step in one tick, but by the
/// Nth part of it in each, which makes the Nth part of that: the rest, (1 - 1/N) of it, is not energy. The first step
/// back is nothing at all, since the pen may have turned within it. So one that swings over more than a step, faster
/// than a step a tick, or both, is counted as it is.
class PenSteps {
 public:
  /// J, of a tick of `dt` (s) in which the pen `moved`, by steps of `resolution` (m); a turn counts as
  /// coupling_radius() times its angle. For every tick in turn.
  double energy(const Displacement& moved, const CouplingSettings& coupling, double resolution, double dt) noexcept;

 private:
  /// Squared length of the part of a step along an axis that makes no energy.
  double uncounted(std::size_t axis, double moved, double step) noexcept;

  struct Axis {
    int direction = 0;  ///< of its last step, 1 or -1; 0: none yet
    int wait = 0;       ///< ticks since then
  };
  std::array<Axis, 6> axes_;
};

}  // namespace tegotae
