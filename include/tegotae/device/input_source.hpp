#pragma once

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Where a hand wants the held part's file frame to be.
struct HandTarget {
  Pose pose;       ///< X_WF, in the world
  Twist velocity;  ///< of the file frame (`v` of its origin), world
};

/// What moves the hand that holds a simulated pen: a script, or a model of an operator.
class InputSource {
 public:
  virtual ~InputSource() = default;

  /// The time at which it begins, s.
  virtual double begin() const noexcept = 0;
  /// Where the hand is then, at rest.
  virtual Pose start() const noexcept = 0;
  /// What the hand wants at `t` (s). `pen` is where the pen is, the file frame's pose: what the hand itself feels of
  /// it. Asked with times that never decrease. Never allocates or throws.
  virtual HandTarget target(double t, const Pose& pen) noexcept = 0;
};

}  // namespace tegotae
