#include "session/pen_port.hpp"

#include <optional>

#include "tegotae/coupling/stability.hpp"
#include "tegotae/transport/attachment.hpp"
#include "tegotae/transport/channel.hpp"

namespace tegotae {

namespace {

class LocalPen final : public PenPort {
 public:
  LocalPen(Device& device, const ServoSettings& servo, bool wall_clock, double scale, const HapticLoop& loop)
      : wall_clock_(wall_clock),
        settings_(servo),
        coupling_(loop.coupling()),
        device_(device),
        channel_(Channel::create()),
        link_(channel_, coupling_, loop.center()) {
    link_.set_scale(scale);
    device_.use_wall_clock(wall_clock);
    device_.set_held_center(loop.center());
  }

  void start() override {
    device_.start();
    try {
      // Asks the device what it is, which some know when they are started.
      servo_.emplace(device_, channel_, settings_);
      if (wall_clock_) servo_->start();
    } catch (...) {
      device_.stop();
      throw;
    }
  }
  void stop() override {
    if (servo_) servo_->stop();
    device_.stop();
  }
  void tick_servo(std::int64_t now_ns) noexcept override { servo_->tick(now_ns); }
  void advance(double dt) noexcept override { device_.advance(dt); }

  bool read(PenSample& pen, std::int64_t) noexcept override {
    PenSample newest;
    // Before the first grasp() there is nothing to obey; a servo that has not heard of this application tells the pen
    // too.
    if (!link_.read(newest) || (homed_ && !link_.obeyed(newest))) return false;
    pen = newest;
    return true;
  }
  void publish(const ProxyState& proxy, const ContactPlanes& planes, std::uint64_t tick, std::uint64_t device_sequence,
               std::int64_t now_ns) noexcept override {
    link_.publish(proxy, tick, device_sequence, now_ns, planes);
  }
  void grasp(const Vec3& center, const CouplingSettings& coupling, const Pose& X) noexcept override {
    link_.grasp(center, coupling, X);
    homed_ = true;
  }

  bool connected() const noexcept override { return true; }
  std::uint64_t losses() const noexcept override { return 0; }
  ServoStatistics statistics() const noexcept override { return servo_ ? servo_->statistics() : ServoStatistics(); }
  std::optional<double> servo_late_us() const noexcept override {
    if (!wall_clock_ || !servo_) return std::nullopt;
    return 1e-3 * static_cast<double>(servo_->newest_late_ns());
  }
  std::string missing_realtime() const override { return servo_ ? servo_->realtime().missing : std::string(); }
  std::string stability() const override {
    return tegotae::stability(device_.info(), coupling_, settings_.rate_hz).text();
  }

 private:
  bool wall_clock_;
  ServoSettings settings_;
  CouplingSettings coupling_;
  Device& device_;
  Channel channel_;
  std::optional<Servo> servo_;  // from start() on
  ContactLink link_;
  bool homed_ = false;
};

class RemotePen final : public PenPort {
 public:
  RemotePen(const std::string& device, double scale, const HapticLoop& loop)
      : attachment_(device, loop.coupling(), loop.center(), scale) {}

  void start() override {}
  void stop() override {}
  void tick_servo(std::int64_t) noexcept override {}
  void advance(double) noexcept override {}

  bool read(PenSample& pen, std::int64_t now_ns) noexcept override { return attachment_.read(pen, now_ns); }
  void publish(const ProxyState& proxy, const ContactPlanes& planes, std::uint64_t tick, std::uint64_t device_sequence,
               std::int64_t now_ns) noexcept override {
    attachment_.publish(proxy, tick, device_sequence, now_ns, planes);
  }

  void grasp(const Vec3& center, const CouplingSettings& coupling, const Pose& X) noexcept override {
    attachment_.grasp(center, coupling, X);
  }

  bool connected() const noexcept override { return attachment_.connected(); }
  std::uint64_t losses() const noexcept override { return attachment_.losses(); }
  ServoStatistics statistics() const noexcept override { return attachment_.statistics(); }
  std::optional<double> servo_late_us() const noexcept override {
    const ServoStatistics servo = attachment_.statistics();
    if (servo.ticks == 0) return std::nullopt;
    return servo.recent_late_us;
  }
  std::string missing_realtime() const override { return {}; }
  std::string stability() const override { return {}; }

 private:
  Attachment attachment_;
};

}  // namespace

std::unique_ptr<PenPort> make_local_pen(Device& device, const ServoSettings& servo, bool wall_clock, double scale,
                                        const HapticLoop& loop) {
  return std::make_unique<LocalPen>(device, servo, wall_clock, scale, loop);
}

std::unique_ptr<PenPort> make_remote_pen(const std::string& device, double scale, const HapticLoop& loop) {
  return std::make_unique<RemotePen>(device, scale, loop);
}

}  // namespace tegotae
