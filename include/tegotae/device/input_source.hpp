#pragma once

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Where a hand wants the held part's file frame to be.
struct HandTarget {
  Pose pose;       ///< X_WF, in the world
  Twist velocity;  ///< of the file frame (`v` of its origin), world
};

/// Source of the motion of the hand that holds a simulated pen: a script or a model of an operator.
class InputSource {
 public:
  virtual ~InputSource() = default;

  /// Returns the time at which the motion begins, s.
  virtual double begin() const noexcept = 0;
  /// Returns where the hand rests at that time.
  virtual Pose start() const noexcept = 0;
  /// Returns what the hand wants at `t` (s). `pen` is the pen's pose, as that of the file frame: what the hand itself
  /// feels of it. Calls come with times that never decrease. Never allocates or throws.
  virtual HandTarget target(double t, const Pose& pen) noexcept = 0;
};

}  // namespace tegotae
