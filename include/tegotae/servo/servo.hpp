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
  double rate_hz = 1000.0;                           ///< 10 to 4000
  RealtimeConfig realtime = RealtimeConfig::ignore;  ///< what start() does when the system refuses real time
  int cpu = -1;                                      ///< CPU to which the thread is bound; negative: the system chooses
  SafetySettings safety;                             ///< safety chain; the device's own limits bound it too
  MappingSettings mapping;                           ///< effect of the pen's buttons
  bool local_model = true;  ///< updates the proxy on the contact planes between two ticks of the contact loop
};

/// The fast loop. A tick reads the pen, maps it, couples it to the newest proxy, passes the wrench through the safety
/// chain to the device, and publishes the pen's state to the application. The servo runs in a thread of its own (start,
/// stop), or the caller drives it (tick), e.g. in virtual time.
class Servo {
 public:
  /// Keeps references to `device` and `channel`; they must outlive the servo. Reads Device::info() here, so a device
  /// that learns its properties when it starts must have been started. Throws Error (kind setting) for a setting out of
  /// range.
  Servo(Device& device, Channel& channel, const ServoSettings& settings = {});
  ~Servo();  ///< stops
  Servo(const Servo&) = delete;
  Servo& operator=(const Servo&) = delete;

  /// Runs tick() in a thread of its own at the set rate, on an absolute schedule of the monotonic clock. The device
  /// must have been started. Throws Error when the servo already runs, and when real time is enforced and not granted.
  void start();
  /// Ends the thread; afterwards the force is zero. Has no effect when the thread does not run.
  void stop() noexcept;

  /// Runs one tick at the time `now_ns`. The servo compares heartbeats with this time, so give ContactLink the same
  /// clock. Never allocates, waits, locks or throws. Do not call it while the thread runs.
  void tick(std::int64_t now_ns) noexcept;

  /// Returns what the system granted to the thread of the last start().
  const RealtimeReport& realtime() const noexcept;
  /// Returns the statistics since construction. While the thread runs they are at most a tenth of a second old.
  ServoStatistics statistics() const noexcept;
  /// Returns how late the thread's newest tick woke up, ns. Any thread may call it.
  std::int64_t newest_late_ns() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tegotae
