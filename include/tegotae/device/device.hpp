#pragma once

#include <cstdint>

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"
#include "tegotae/device/shm.h"

namespace tegotae TEGOTAE_EXPORT {

/// One snapshot of the pen.
struct DeviceState {
  Pose pose;                   ///< X_WF: where the pen wants the held part's file frame, in the world
  Twist velocity;              ///< of the pen's body; `v` is that of the held part's center of mass (Device::center)
  std::uint32_t buttons = 0;   ///< bit i: button i is pressed
  std::int64_t time_ns = 0;    ///< when it was sampled: the monotonic clock, or the device's own in virtual time
  std::uint64_t sequence = 0;  ///< number of the sample
};

enum class DeviceStatus : std::uint32_t {
  uninitialized = TEGOTAE_SHM_STATUS_UNINITIALIZED,  ///< not started: no pose, no force
  ready = TEGOTAE_SHM_STATUS_READY,                  ///< the pose is good, the force is off
  enabled = TEGOTAE_SHM_STATUS_ENABLED,              ///< the pose is good and wrenches are rendered
};

/// Why the force is off.
enum class ForceOff : std::uint32_t {
  none = TEGOTAE_SHM_REASON_NONE,  ///< it is on
  button = TEGOTAE_SHM_REASON_BUTTON,
  velocity = TEGOTAE_SHM_REASON_VELOCITY,
  watchdog = TEGOTAE_SHM_REASON_WATCHDOG,
  software = TEGOTAE_SHM_REASON_SOFTWARE,
  disconnected = TEGOTAE_SHM_REASON_DISCONNECTED,
  dead_man = TEGOTAE_SHM_REASON_DEAD_MAN,
  not_finite = TEGOTAE_SHM_REASON_NOT_FINITE,
};

/// For people, e.g. "the contact loop's heartbeat is too old".
const char* to_string(DeviceStatus status) noexcept;
const char* to_string(ForceOff reason) noexcept;

/// A haptic pen, scaled and placed so that it speaks of the held part. Called from one thread, the servo's.
class Device {
 public:
  virtual ~Device() = default;

  /// Connects and makes the device ready or enabled. Throws Error with the cause.
  virtual void start() = 0;
  /// Force off, disconnects. Throws Error when the device cannot be left in a safe state.
  virtual void stop() = 0;

  /// The newest state. Never waits. When the device does not answer: the last state, and reason() says so.
  virtual DeviceState read() noexcept = 0;
  /// Renders `wrench` (on the pen, at the held part's center of mass, world) until the next call.
  virtual void write(const Wrench& wrench) noexcept = 0;

  virtual DeviceStatus status() const noexcept = 0;
  virtual ForceOff reason() const noexcept = 0;

  /// The held part's center of mass in its file frame, m: the point of the pen's body of which DeviceState::velocity
  /// tells the velocity and at which wrenches act. The servo sets it from what the application says.
  const Vec3& center() const noexcept { return center_; }
  virtual void set_center(const Vec3& center) noexcept { center_ = center; }

 private:
  Vec3 center_ = Vec3::Zero();
};

}  // namespace tegotae
