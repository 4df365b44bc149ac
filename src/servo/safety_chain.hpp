#pragma once

#include <cstdint>

#include "tegotae/device/device.hpp"
#include "tegotae/servo/servo.hpp"

namespace tegotae {

/// What a tick knows when its wrench is about to leave.
struct SafetyInput {
  Wrench wanted;
  DeviceStatus device_status;
  ForceOff device_reason;
  bool attached;              ///< an application has ever written
  std::int64_t heartbeat_ns;  ///< of its contact loop
  std::int64_t now_ns;        ///< of the same clock
};

struct SafetyOutput {
  Wrench wrench;                     ///< zero unless `reason` is none
  ForceOff reason = ForceOff::none;  ///< the first link that turned the force off
};

/// The one place that a wrench passes right before it is written to the device. Links, in order: the device must be
/// enabled; an application must be there; its heartbeat must be fresh; the wrench must be finite; force and torque are
/// saturated together.
class SafetyChain {
 public:
  /// Throws Error for a setting out of range.
  explicit SafetyChain(const SafetySettings& settings);
  SafetyOutput apply(const SafetyInput& in) noexcept;

 private:
  WrenchLimits limits_;
  std::int64_t timeout_ns_;
};

}  // namespace tegotae
