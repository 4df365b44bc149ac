#pragma once

#include <cstdint>
#include <memory>

#include "tegotae/core/export.hpp"
#include "tegotae/device/device.hpp"
#include "tegotae/device/input_guide.hpp"
#include "tegotae/device/input_source.hpp"
#include "tegotae/device/limits.hpp"
#include "tegotae/device/script.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// The hand that holds the pen. Springs and dampers pull the pen to the script's pose, and the effective mass of the
/// hand moves with the pen. The defaults are a relaxed pen grip, near critical damping.
struct HandSettings {
  double stiffness = 400.0;          ///< N/m
  double damping = 24.0;             ///< N·s/m, on the difference to the script's velocity
  double torsional_stiffness = 1.5;  ///< N·m/rad
  double torsional_damping = 0.04;   ///< N·m·s/rad, on the difference to the script's angular velocity
  double mass = 0.3;                 ///< kg
  double inertia = 2e-4;             ///< kg·m², about the held part's center of mass, any axis
};

/// Settings of a pen like the PHANTOM Premium 1.5/6DOF. Apparent mass, friction, force limits and position resolution
/// are the vendor's figures; the rotational inertia and resolution and the velocity filter are assumed.
struct SimulatedDeviceSettings {
  HandSettings hand;                            ///< the hand that holds it
  double mass = 0.075;                          ///< apparent, kg
  Vec3 inertia = Vec3(1.2e-4, 1.2e-4, 0.4e-4);  ///< about the center of mass along the file frame's axes, kg·m²
  double friction = 0.04;                       ///< Coulomb, N
  WrenchLimits limits;                          ///< bounds of the rendered wrench, whatever the application asks for
  double continuous_force = 1.4;                ///< N, force that the motors can sustain; 0: unbounded
  double position_resolution = 3e-5;            ///< m, of the center of mass; 0: none
  double rotation_resolution = 1e-4;            ///< rad; 0: none
  /// Cutoff (Hz) of the low-pass filter on the velocity, which is computed from the steps of the pose.
  double velocity_cutoff_hz = 50.0;
  bool wall_clock = false;  ///< read() advances by the time since the last read(); otherwise only advance() does
  /// On the wall clock, the hand waits at the script's first pose until an application attaches.
  bool wait_for_application = false;
};

/// Returns the DeviceInfo of a SimulatedDevice with `settings`.
DeviceInfo device_info(const SimulatedDeviceSettings& settings);

/// A pen without hardware: a rigid body that a hand and the rendered wrench push. The hand follows a script or an
/// InputSource. The same settings, script and calls give the same bits.
class SimulatedDevice final : public Device {
 public:
  /// Starts at rest at the script's first pose. `center` is the held part's center of mass (m, file frame). Throws
  /// Error (kind setting) for a setting that is not finite or out of range.
  SimulatedDevice(const SimulatedDeviceSettings& settings, StylusScript script, const Vec3& center = Vec3::Zero());
  /// Starts at rest at the pose where `hand` begins. Keeps a reference to `hand`, which must outlive the device. Throws
  /// Error like the other constructor.
  SimulatedDevice(const SimulatedDeviceSettings& settings, InputSource& hand, const Vec3& center = Vec3::Zero());
  ~SimulatedDevice() override;

  /// Returns its properties. Their damping is the hand's, because the hand never lets go.
  DeviceInfo info() const override;
  void start() override;
  void stop() override;
  DeviceState read() noexcept override;
  void write(const Wrench& wrench) noexcept override;
  DeviceStatus status() const noexcept override;
  ForceOff reason() const noexcept override;
  Vec3 reference_point() const noexcept override;              ///< the held part's center of mass
  void set_held_center(const Vec3& center) noexcept override;  ///< pose and motion stay
  void set_tracking_error(
      const Displacement& lead) noexcept override;  ///< a call shows that an application is attached
  void use_wall_clock(bool on) noexcept override;   ///< sets SimulatedDeviceSettings::wall_clock

  /// Makes the hand follow `guide`, and no longer the script, from the first InputGuide::lead() on. Call it before
  /// start(). Keeps a reference to `guide`, which must outlive the device.
  void follow(const InputGuide& guide) noexcept;
  /// Advances by `dt` seconds (rounded to 1 ns) of virtual time, also before start().
  void advance(double dt) noexcept override;
  /// Returns the time of the hand, s: the begin of the script plus the time advanced. Any thread may call it.
  double script_time() const noexcept;
  /// Returns the exact pose X_WF, before resolution and filter.
  Pose true_pose() const noexcept;
  Twist true_velocity() const noexcept;  ///< exact velocity: `v` of the center of mass (m/s) and `w` (rad/s), world

 private:
  struct Impl;
  SimulatedDevice(std::unique_ptr<Impl> impl, const Vec3& center);
  std::unique_ptr<Impl> impl_;
};

}  // namespace tegotae
