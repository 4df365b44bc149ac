#pragma once

#include <cstdint>
#include <string>

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"
#include "tegotae/device/limits.hpp"
#include "tegotae/device/shm.h"

namespace tegotae TEGOTAE_EXPORT {

/// Properties of a device, as far as its vendor states them. The defaults are those of a PHANTOM Premium 1.5/6DOF.
struct DeviceInfo {
  std::string name = "pen";           ///< applications see at most TEGOTAE_SHM_NAME - 1 bytes of it
  int motion_freedom = 6;             ///< sensed degrees of freedom: 3 or 6
  int force_freedom = 6;              ///< rendered degrees of freedom: 0 (input only), 3 or 6
  WrenchLimits limits;                ///< peak
  double continuous_force = 1.4;      ///< N, force that its motors can sustain; 0: unbounded
  double damping = 0;                 ///< N·s/m, of the device alone; 0: not known
  double torsional_damping = 0;       ///< N·m·s/rad; 0: not known
  double friction = 0.04;             ///< Coulomb friction, N
  double position_resolution = 3e-5;  ///< m
};

/// One snapshot of the pen.
struct DeviceState {
  Pose pose;                  ///< X_WF: the pen's frame in the device's own space, whose axes are those of the world
  Twist velocity;             ///< of the pen's body; `v` is that of Device::reference_point()
  std::uint32_t buttons = 0;  ///< bit i: button i is pressed
  std::int64_t time_ns = 0;  ///< time of sampling: of the monotonic clock, or in virtual time of the device's own clock
  std::uint64_t sequence = 0;  ///< number of the sample
};

/// What a device can do at present.
enum class DeviceStatus : std::uint32_t {
  uninitialized = TEGOTAE_SHM_STATUS_UNINITIALIZED,  ///< not started: no pose, no force
  ready = TEGOTAE_SHM_STATUS_READY,                  ///< the pose is good, the force is off
  enabled = TEGOTAE_SHM_STATUS_ENABLED,              ///< the pose is good and wrenches are rendered
};

/// Why the force is off.
enum class ForceOff : std::uint32_t {
  none = TEGOTAE_SHM_REASON_NONE,                      ///< it is on
  button = TEGOTAE_SHM_REASON_BUTTON,                  ///< the device's force button is off
  velocity = TEGOTAE_SHM_REASON_VELOCITY,              ///< the pen moved too fast
  watchdog = TEGOTAE_SHM_REASON_WATCHDOG,              ///< the application's heartbeat is too old
  software = TEGOTAE_SHM_REASON_SOFTWARE,              ///< no application asks for force
  disconnected = TEGOTAE_SHM_REASON_DISCONNECTED,      ///< the device does not answer
  dead_man = TEGOTAE_SHM_REASON_DEAD_MAN,              ///< the dead-man switch is released
  not_finite = TEGOTAE_SHM_REASON_NOT_FINITE,          ///< a pose, velocity or setting is not finite
  workspace = TEGOTAE_SHM_REASON_WORKSPACE,            ///< the pen left its workspace
  energy = TEGOTAE_SHM_REASON_ENERGY,                  ///< the coupling gave the hand more energy than allowed
  thermal = TEGOTAE_SHM_REASON_THERMAL,                ///< the motors are too warm
  engage = TEGOTAE_SHM_REASON_ENGAGE,                  ///< waits until the wanted force is small, then ramps in
  clutched = TEGOTAE_SHM_REASON_CLUTCHED,              ///< the pen moves without the part
  silent = TEGOTAE_SHM_REASON_SILENT,                  ///< the pen has sent no new sample for too long
  device_fault = TEGOTAE_SHM_REASON_DEVICE_FAULT,      ///< the device reports a fault
  force_exceeded = TEGOTAE_SHM_REASON_FORCE_EXCEEDED,  ///< the application asked for more than the device may render
  no_force = TEGOTAE_SHM_REASON_NO_FORCE,              ///< the device is an input only
};

/// Returns a text for people, e.g. "ready, force off".
const char* to_string(DeviceStatus status) noexcept;
const char* to_string(ForceOff reason) noexcept;  ///< returns a text for people, e.g. "the pen moved too fast"

/// A haptic pen in its own space: SI units, axes of the world. The servo maps it to the held part. Only one thread
/// makes calls, the servo's; any thread may call info().
class Device {
 public:
  virtual ~Device() = default;

  /// Returns the device's properties. They do not change while the device is started.
  virtual DeviceInfo info() const = 0;

  /// Connects, and makes the device ready or enabled. Throws Error with the cause when it cannot be used.
  virtual void start() = 0;
  /// Switches the force off and disconnects. Throws Error when the device cannot be left in a safe state.
  virtual void stop() = 0;

  /// Returns the newest state. Never waits. When the device does not answer, it returns the last state, and reason()
  /// says so.
  virtual DeviceState read() noexcept = 0;
  /// Renders `wrench` (on the pen, at reference_point(), in the axes of the world, N and N·m) until the next call.
  virtual void write(const Wrench& wrench) noexcept = 0;

  virtual DeviceStatus status() const noexcept = 0;  ///< returns its present status
  virtual ForceOff reason() const noexcept = 0;      ///< returns why it renders no force; ForceOff::none when it does

  /// Returns the device's reference point, in the pen's frame, m. DeviceState::velocity is the velocity of this point,
  /// and wrenches act at it. The servo maps it to the held part's center of mass. The default is the origin of the
  /// pen's frame.
  virtual Vec3 reference_point() const noexcept { return Vec3::Zero(); }
  /// Receives the held part's center of mass (m, file frame) each time that another part is held. Only a pen whose body
  /// is the part itself uses it, as its reference point, as SimulatedDevice does. Other drivers ignore it.
  virtual void set_held_center(const Vec3&) noexcept {}

  /// Sets whether the device moves with the clock (hardware always does) or by advance() alone. The rig or run calls it
  /// before start().
  virtual void use_wall_clock(bool) noexcept {}
  /// Advances a device that does not move with the clock by `dt` seconds of virtual time. Called between two calls of
  /// read().
  virtual void advance(double) noexcept {}

  /// Receives the tracking error: the displacement of the held part's center of mass from the part's pose to the pose
  /// where the pen wants it, in the world's axes and the pen's meters. The servo calls it before read() while an
  /// application is attached. An input that is integrated uses it to stay near the part.
  virtual void set_tracking_error(const Displacement&) noexcept {}
};

}  // namespace tegotae
