#pragma once

#include <cstdint>

#include "servo/safety_links.hpp"
#include "tegotae/servo/safety.hpp"

namespace tegotae {

/// What a tick knows when its wrench is about to leave.
struct SafetyInput {
  Wrench wanted;
  DeviceStatus device_status = DeviceStatus::uninitialized;
  ForceOff device_reason = ForceOff::none;
  int force_freedom = 6;   ///< of the device; 0: it renders no force
  bool pen_valid = false;  ///< its pose and velocity are finite and a pose
  bool pen_silent = false;
  bool pen_fast = false;
  Vec3 pen = Vec3::Zero();  ///< in the device's space, m
  std::uint32_t buttons = 0;
  bool attached = false;     ///< an application has ever written
  bool force_asked = false;  ///< by the application
  bool valid = false;        ///< what the application says can be
  bool clutched = false;
  bool remapped = false;  ///< scale, clutch, home or the application changed: what was engaged is another thing now
  double energy = 0;      ///< J, of the passivity observer
  std::int64_t heartbeat_ns = 0;  ///< of the contact loop
  std::int64_t now_ns = 0;        ///< of the same clock
  double dt = 0;                  ///< s since the last tick
};

struct SafetyOutput {
  Wrench wrench;                     ///< on its way to zero, or zero, unless `reason` is none
  ForceOff reason = ForceOff::none;  ///< the first link that turned the force off
  std::uint32_t flags = 0;           ///< TEGOTAE_SHM_FLAG_...
  bool unmodified = false;           ///< the wrench is the wanted one, nothing cut or faded
};

/// The one place that a wrench passes right before it is written to the device. First the links that turn it off, in
/// the order of off(); then force and torque are saturated together, cut to the thermal budget, faded at the border of
/// the workspace, ramped or faded by the gate, and limited in how fast they change.
class SafetyChain {
 public:
  /// Throws Error for a setting out of range.
  explicit SafetyChain(const SafetySettings& settings);
  SafetyOutput apply(const SafetyInput& in) noexcept;
  double thermal_load() const noexcept { return thermal_.load(); }
  /// Whether a heartbeat of the contact loop is fresh; one from the future is no better than an old one.
  bool alive(std::int64_t heartbeat_ns, std::int64_t now_ns) const noexcept;

 private:
  /// Why the force must be zero at once, or none.
  ForceOff emergency(const SafetyInput& in) const noexcept;
  /// Why it must fade out, or none.
  ForceOff off(const SafetyInput& in, double workspace) const noexcept;

  SafetySettings settings_;
  std::int64_t timeout_ns_;
  ThermalBudget thermal_;
  ForceGate gate_;
  SlewLimit slew_;
  Wrench shaped_;  // what was let through last while the force was on; a fade starts from it
};

}  // namespace tegotae
