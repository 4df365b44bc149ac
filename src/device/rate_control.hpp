#pragma once

#include "tegotae/core/pose.hpp"
#include "tegotae/device/input_devices.hpp"

namespace tegotae {

/// Along and about the axes of the world, full deflection being 1.
struct Deflection {
  Vec3 linear = Vec3::Zero();
  Vec3 angular = Vec3::Zero();
};

/// From deflections to a pose.
class RateControl {
 public:
  /// Throws Error for a setting out of range.
  explicit RateControl(const RateControlSettings& settings);

  /// Moves on by `dt` seconds. `lead` is how far the pen is ahead of the part: from the part to where the pen wants it.
  void step(const Deflection& deflection, double dt, const Displacement& lead) noexcept;
  /// Stays where it is.
  void rest() noexcept { velocity_ = {}; }

  const Pose& pose() const noexcept { return pose_; }
  const Twist& velocity() const noexcept { return velocity_; }

 private:
  RateControlSettings settings_;
  Pose pose_;
  Twist velocity_;
};

}  // namespace tegotae
