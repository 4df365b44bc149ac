#pragma once

#include <memory>
#include <optional>
#include <string>

#include "tegotae/device/device.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/servo/servo.hpp"
#include "tegotae/transport/contact_link.hpp"

namespace tegotae {

/// A pen with its servo, as a contact loop sees them, in this process or in another one.
class PenPort {
 public:
  virtual ~PenPort() = default;
  /// On the wall clock the servo runs from start() to stop(); in virtual time tick_servo() and advance() drive it.
  virtual void start() = 0;
  virtual void stop() = 0;
  /// In virtual time: a servo tick at `now_ns`, and after the contact loop's tick the pen `dt` seconds on.
  virtual void tick_servo(std::int64_t now_ns) noexcept = 0;
  virtual void advance(double dt) noexcept = 0;

  /// The newest sample; false when there is none to follow, and the part stays.
  virtual bool read(PenSample& pen, std::int64_t now_ns) noexcept = 0;
  /// The answer to the pen's sample `device_sequence`, with what the servo needs to go on between two ticks.
  virtual void publish(const ProxyState& proxy, const ContactPlanes& planes, std::uint64_t tick,
                       std::uint64_t device_sequence, std::int64_t now_ns) noexcept = 0;

  /// Another part is held from now on (see ContactLink::grasp); there is no sample until the servo has heard of it.
  virtual void grasp(const Vec3& center, const CouplingSettings& coupling, const Pose& X) noexcept = 0;

  virtual bool connected() const noexcept = 0;
  virtual std::uint64_t losses() const noexcept = 0;
  virtual ServoStatistics statistics() const noexcept = 0;
  /// TickView::servo_late_us.
  virtual std::optional<double> servo_late_us() const noexcept = 0;
  /// RunSummary::missing_realtime and stability.
  virtual std::string missing_realtime() const = 0;
  virtual std::string stability() const = 0;
};

/// `device` with a servo of its own, in this process. Keeps a reference to the device. `scale`: Scene::scale.
std::unique_ptr<PenPort> make_local_pen(Device& device, const ServoSettings& servo, bool wall_clock, double scale,
                                        const HapticLoop& loop);
/// A device in another process, "shm:NAME". Throws Error when there is none.
std::unique_ptr<PenPort> make_remote_pen(const std::string& device, double scale, const HapticLoop& loop);

}  // namespace tegotae
