#pragma once

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Pose where a hand wants the held part's file frame to be, and its velocity there.
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
  /// Returns the pose X_WF (world) where the hand rests at that time.
  virtual Pose start() const noexcept = 0;
  /// Returns the pose that the hand wants at `t` (s), and its velocity. `pen` is the pen's present pose, which the hand
  /// feels, as that of the file frame (X_WF). The times of the calls never decrease. Never allocates or throws.
  virtual HandTarget target(double t, const Pose& pen) noexcept = 0;
};

}  // namespace tegotae
