#pragma once

#include <array>
#include <cstdint>

#include "tegotae/core/pose.hpp"

namespace tegotae {

/// The velocity that a driver makes of successive poses: what they tell of the way, through a low-pass of first order.
///
/// Poses come in steps of the resolution. A coordinate that is a step farther after a wait has not moved by a step
/// within one sample, but by its share in each; after a wait a first step back tells of no way at all, since the pen
/// may have turned round within it; and where no step came for 0.1 s the pen stands. Differences would make a kick of
/// every step, which a damper hands on to the hand. Steps that follow each other faster are differences all the same.
class VelocityFilter {
 public:
  /// `resolution` of the point (m) and `turn_resolution` (rad), along each axis; 0 where there is none or it is not
  /// known.
  VelocityFilter(double cutoff_hz, double resolution, double turn_resolution)
      : cutoff_hz_(cutoff_hz), resolution_(resolution), turn_resolution_(turn_resolution) {}
  /// A sample of the pen's point and rotation at `time_ns`.
  void add(const Vec3& point, const Quat& rotation, std::int64_t time_ns) noexcept;
  /// The next sample is a jump of the point, not a motion.
  void forget() noexcept { sampled_ = false; }
  const Twist& velocity() const noexcept { return filtered_; }

 private:
  /// A coordinate that comes in steps.
  struct Axis {
    int direction = 0;  ///< of its last step, 1 or -1; 0: none yet
    double since = 0;   ///< s since then
    double rate = 0;    ///< that its steps tell, 1/s times their unit

    /// What the steps tell when it `moved` in the last `dt` (s).
    double add(double moved, double resolution, double dt) noexcept;
  };

  Vec3 rate(std::array<Axis, 3>& axes, const Vec3& moved, double resolution, double dt) noexcept;

  double cutoff_hz_, resolution_, turn_resolution_;
  std::array<Axis, 3> shift_, turn_;
  bool sampled_ = false;
  std::int64_t time_ns_ = 0;
  Vec3 point_ = Vec3::Zero();
  Quat rotation_ = Quat::Identity();
  Twist filtered_;
};

}  // namespace tegotae
