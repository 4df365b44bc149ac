#pragma once

#include <cstdint>

#include "tegotae/core/pose.hpp"

namespace tegotae {

/// The velocity that a driver makes of successive poses: differences through a low-pass of first order.
class VelocityFilter {
 public:
  explicit VelocityFilter(double cutoff_hz) : cutoff_hz_(cutoff_hz) {}
  /// A sample of the pen's point and rotation at `time_ns`.
  void add(const Vec3& point, const Quat& rotation, std::int64_t time_ns) noexcept;
  /// The next sample is a jump of the point, not a motion.
  void forget() noexcept { sampled_ = false; }
  const Twist& velocity() const noexcept { return filtered_; }

 private:
  double cutoff_hz_;
  bool sampled_ = false;
  std::int64_t time_ns_ = 0;
  Vec3 point_ = Vec3::Zero();
  Quat rotation_ = Quat::Identity();
  Twist filtered_;
};

}  // namespace tegotae
