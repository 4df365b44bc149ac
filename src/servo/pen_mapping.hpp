#pragma once

#include "tegotae/device/device.hpp"
#include "tegotae/transport/mapping.hpp"

namespace tegotae {

/// What the application wants of the mapping.
struct MappingCommand {
  double scale = 1;
  Clutch clutch = Clutch::none;
  std::uint32_t home_counter = 0;  ///< a new value other than 0 in an attachment: Y jumps to `home`
  Pose home;                       ///< of the held part's file frame
  std::int64_t attachment = 0;
  Vec3 center = Vec3::Zero();  ///< of mass of the held part, file frame, m
};

/// From the pen in the device's own space to Y, where the pen wants the held part. The part's center of mass moves by
/// `scale` times the way of the pen's center and turns as the pen does. A change of scale or clutch never moves Y; home
/// does. Before the first command the pen is the part: Y's center is where the pen's is.
class PenMapping {
 public:
  explicit PenMapping(const MappingSettings& settings) : settings_(settings) {}

  /// A new state of the pen, which must be valid; `pen_center` is Device::reference_point(). Returns whether the
  /// mapping is another one than before, so that the force must be engaged anew.
  bool update(const DeviceState& pen, const Vec3& pen_center, const MappingCommand& command) noexcept;

  const Pose& Y() const noexcept { return Y_; }
  /// `v` of the held part's center of mass.
  const Twist& velocity() const noexcept { return velocity_; }
  double scale() const noexcept { return scale_; }
  Clutch clutch() const noexcept { return clutch_; }
  std::uint32_t home_counter() const noexcept { return home_counter_; }

 private:
  void anchor(const Vec3& pen, const Quat& pen_q, const Vec3& part, const Quat& part_q) noexcept;

  MappingSettings settings_;
  bool started_ = false;
  double scale_ = 1;
  Clutch clutch_ = Clutch::none;
  std::uint32_t home_counter_ = 0;
  std::int64_t attachment_ = 0;
  Vec3 pen_center_ = Vec3::Zero(), center_ = Vec3::Zero();
  // Where pen and part were together last.
  Vec3 pen_anchor_ = Vec3::Zero(), part_anchor_ = Vec3::Zero();
  Quat pen_anchor_q_ = Quat::Identity(), part_anchor_q_ = Quat::Identity();
  Pose pen_;  // last
  Pose Y_;
  Twist velocity_;
};

}  // namespace tegotae
