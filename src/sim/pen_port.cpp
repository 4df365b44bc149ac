#include "sim/run_pen.hpp"

#include <limits>

#include "tegotae/coupling/stability.hpp"
#include "tegotae/device/channel.hpp"
#include "tegotae/servo/attachment.hpp"

namespace tegotae {

namespace {

SimulatedDeviceSettings with_clock(SimulatedDeviceSettings settings, bool wall_clock) {
  settings.wall_clock = wall_clock;
  return settings;
}

ServoSettings servo_settings(const SceneFile& file) {
  ServoSettings s;
  s.safety = file.safety;
  return s;
}

SimulatedDevice make_device(const SceneFile& file, const HapticLoop& loop, bool wall_clock, HandIntent* hand) {
  const SimulatedDeviceSettings settings = with_clock(file.device, wall_clock);
  return hand ? SimulatedDevice(settings, *hand, loop.center()) : SimulatedDevice(settings, file.script, loop.center());
}

class LocalPen final : public RunPen {
 public:
  LocalPen(const SceneFile& file, const HapticLoop& loop, bool wall_clock, HandIntent* hand, const HandGuide* guide)
      : wall_clock_(wall_clock),
        device_(make_device(file, loop, wall_clock, hand)),
        channel_(Channel::create()),
        servo_(device_, channel_, servo_settings(file)),
        link_(channel_, loop.coupling(), loop.center()),
        stability_(tegotae::stability(device_.info(), loop.coupling(), ServoSettings().rate_hz).text()) {
    link_.set_scale(file.scene.scale);
    if (guide) device_.follow(*guide);
  }

  void start() override {
    device_.start();
    if (wall_clock_) servo_.start();
  }
  void stop() override {
    servo_.stop();
    device_.stop();
  }
  void tick_servo(std::int64_t now_ns) noexcept override { servo_.tick(now_ns); }
  void advance(double dt) noexcept override { device_.advance(dt); }

  bool read(PenSample& pen, std::int64_t) noexcept override {
    PenSample newest;
    // Before the first hold() there is nothing to obey; a servo that has not heard of this application tells the pen
    // too.
    if (!link_.read(newest) || (homed_ && !link_.obeyed(newest))) return false;
    pen = newest;
    return true;
  }
  void publish(const ProxyState& proxy, const ContactPlanes& planes, std::uint64_t tick, std::uint64_t device_sequence,
               std::int64_t now_ns) noexcept override {
    link_.publish(proxy, tick, device_sequence, now_ns, planes);
  }
  void hold(const Vec3& center, const CouplingSettings& coupling, const Pose& X) noexcept override {
    link_.hold(center, coupling, X);
    homed_ = true;
  }

  bool connected() const noexcept override { return true; }
  std::uint64_t losses() const noexcept override { return 0; }
  ServoStatistics statistics() const noexcept override { return servo_.statistics(); }
  double servo_late_us() const noexcept override {
    return wall_clock_ ? 1e-3 * static_cast<double>(servo_.newest_late_ns()) : std::numeric_limits<double>::quiet_NaN();
  }
  std::string missing_realtime() const override { return servo_.realtime().missing; }
  std::string stability() const override { return stability_; }

 private:
  bool wall_clock_;
  SimulatedDevice device_;
  Channel channel_;
  Servo servo_;
  ContactLink link_;
  bool homed_ = false;
  std::string stability_;
};

class RemotePen final : public RunPen {
 public:
  RemotePen(const std::string& device, const SceneFile& file, const HapticLoop& loop)
      : attachment_(device, loop.coupling(), loop.center(), file.scene.scale) {}

  void start() override {}
  void stop() override {}
  void tick_servo(std::int64_t) noexcept override {}
  void advance(double) noexcept override {}

  bool read(PenSample& pen, std::int64_t now_ns) noexcept override { return attachment_.read(pen, now_ns); }
  void publish(const ProxyState& proxy, const ContactPlanes& planes, std::uint64_t tick, std::uint64_t device_sequence,
               std::int64_t now_ns) noexcept override {
    attachment_.publish(proxy, tick, device_sequence, now_ns, planes);
  }

  void hold(const Vec3& center, const CouplingSettings& coupling, const Pose& X) noexcept override {
    attachment_.hold(center, coupling, X);
  }

  bool connected() const noexcept override { return attachment_.connected(); }
  std::uint64_t losses() const noexcept override { return attachment_.losses(); }
  ServoStatistics statistics() const noexcept override { return attachment_.statistics(); }
  double servo_late_us() const noexcept override {
    const ServoStatistics servo = attachment_.statistics();
    return servo.ticks > 0 ? servo.recent_late_us : std::numeric_limits<double>::quiet_NaN();
  }
  std::string missing_realtime() const override { return {}; }
  std::string stability() const override { return {}; }

 private:
  Attachment attachment_;
};

}  // namespace

std::unique_ptr<RunPen> make_local_pen(const SceneFile& file, const HapticLoop& loop, bool wall_clock, HandIntent* hand,
                                       const HandGuide* guide) {
  return std::make_unique<LocalPen>(file, loop, wall_clock, hand, guide);
}

std::unique_ptr<RunPen> make_remote_pen(const std::string& device, const SceneFile& file, const HapticLoop& loop) {
  return std::make_unique<RemotePen>(device, file, loop);
}

}  // namespace tegotae
