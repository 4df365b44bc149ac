#pragma once

#include <cstdint>
#include <memory>

#include "tegotae/core/export.hpp"
#include "tegotae/device/device.hpp"
#include "tegotae/servo/realtime.hpp"
#include "tegotae/servo/safety.hpp"
#include "tegotae/transport/channel.hpp"
#include "tegotae/transport/mapping.hpp"
#include "tegotae/transport/servo_statistics.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// How a servo runs.
struct ServoSettings {
  double rate_hz = 1000.0;                           ///< up to 4000
  RealtimeConfig realtime = RealtimeConfig::ignore;  ///< what start() does without real time
  int cpu = -1;             ///< that the thread is bound to; negative: wherever the system puts it
  SafetySettings safety;    ///< of the chain that every wrench passes
  MappingSettings mapping;  ///< buttons
  bool local_model = true;  ///< bring the proxy up to date on the contact planes between two ticks of the contact loop
};

/// The fast loop: pen in, mapping, coupling to the newest proxy, safety chain, wrench out, pen state to the
/// application. Either as a thread of its own (start, stop) or driven by the caller (tick), e.g. in virtual time.
class Servo {
 public:
  /// Keeps references to both; they must outlive the servo. What the device is (Device::info) is asked here: a device
  /// that learns it when it starts must have been started. Throws Error for a setting out of range.
  Servo(Device& device, Channel& channel, const ServoSettings& settings = {});
  ~Servo();  ///< stops
  Servo(const Servo&) = delete;
  Servo& operator=(const Servo&) = delete;

  /// Runs tick() in a thread at the set rate on an absolute schedule of the monotonic clock. The device must have been
  /// started. Throws Error when real time is enforced and not granted.
  void start();
  /// Ends the thread, after which the force is zero. No effect when it does not run.
  void stop() noexcept;

  /// One tick at the time `now_ns`; heartbeats are compared with it, so give ContactLink the same clock. Never
  /// allocates, waits, locks or throws. Not while the thread runs.
  void tick(std::int64_t now_ns) noexcept;

  /// What the system granted to the thread of the last start().
  const RealtimeReport& realtime() const noexcept;
  /// While the thread runs: as of at most a tenth of a second ago.
  ServoStatistics statistics() const noexcept;
  /// How late the thread's newest tick woke up, ns.
  std::int64_t newest_late_ns() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tegotae
