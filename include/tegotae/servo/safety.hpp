#pragma once

#include <limits>

#include "tegotae/core/export.hpp"
#include "tegotae/device/device.hpp"
#include "tegotae/device/limits.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Settings of the safety chain, which every wrench passes before it leaves. The defaults suit a PHANTOM
/// Premium 1.5/6DOF.
struct SafetySettings {
  WrenchLimits limits;  ///< N and N·m, peak

  /// Timeout, s, above 0 to 1. When the heartbeat of the contact loop is older, the force fades out.
  double heartbeat_timeout = 0.02;
  /// Timeout, s, above 0 to 1. When the pen has sent no new sample for so long, the force fades out.
  double silence_timeout = 0.02;
  double fade_time = 0.003;  ///< s from full force to none; with heartbeat_timeout under 25 ms by default
  double ramp_time = 0.2;    ///< s from no force to full force

  /// N and N·m. A force that was off comes on again once the wanted force and torque have stayed below this for
  /// engage_time.
  WrenchLimits engage = {0.2, 0.005};
  double engage_time = 0.01;  ///< s

  /// Fastest change of the rendered force (N/s) and torque (N·m/s), also while they fade. Only an emergency (a value
  /// that is not finite, a device that is not enabled) is faster.
  WrenchLimits slew = {3000, 70};

  double velocity_limit = 2.0;           ///< m/s of the pen; a faster pen turns the force off
  double angular_velocity_limit = 50.0;  ///< rad/s of the pen; the same for rotations

  /// N. The running RMS of the force over thermal_time does not exceed it: the allowed peak shrinks as the RMS
  /// approaches it. 0: unbounded.
  double continuous_force = 1.4;
  double thermal_time = 30.0;  ///< s

  /// Center, m, of a box in the device's space. Inside the box the pen renders its full force. Outside, the force fades
  /// over workspace_margin.
  Vec3 workspace_center = Vec3::Zero();
  /// Half the box's sides, m; infinite: no border.
  Vec3 workspace_half = Vec3::Constant(std::numeric_limits<double>::infinity());
  double workspace_margin = 0.02;  ///< m

  /// J that the coupling may give the hand beyond what the hand put in. With more, the force goes off as unstable.
  double energy_bound = 0.01;
  bool passivity_control = true;  ///< damps the pen as soon as the hand gets such energy

  std::uint32_t dead_man_buttons = 0;  ///< the force is on only while one of these is pressed; 0: no dead-man switch
};

/// Largest timeout, s. A longer one would keep a force that nobody updates for longer than a hand takes to notice it.
inline constexpr double kMaxTimeout = 1.0;

/// Checks `settings`. Throws Error (kind setting) that names the first setting out of range.
void check(const SafetySettings& settings);

}  // namespace tegotae
