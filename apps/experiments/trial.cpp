#include "experiments/trial.hpp"

#include <algorithm>
#include <limits>

#include "session/pose_check.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/resolve/resolver.hpp"
#include "tegotae/servo/servo.hpp"
#include "tegotae/transport/contact_link.hpp"

namespace tegotae::experiments {
namespace {

constexpr std::int64_t kPeriodNs = 1'000'000;
constexpr double kPeriod = 1e-9 * kPeriodNs;

}  // namespace

std::vector<Sample> run_trial(Scene scene, const SimulatedDeviceSettings& pen_settings, InputSource& hand, Operator* op,
                              double seconds, const std::function<bool(const Sample&)>& done) {
  scene.contact.tick_budget = std::numeric_limits<double>::infinity();
  HapticLoop loop(scene);
  // Pushes of seconds would come under the motors' thermal budget; here the force itself is looked at.
  SimulatedDeviceSettings tireless = pen_settings;
  tireless.continuous_force = 0;
  ServoSettings servo_settings;
  servo_settings.safety.continuous_force = 0;
  SimulatedDevice device(tireless, hand, loop.center());
  Channel channel = Channel::create();
  Servo servo(device, channel, servo_settings);
  ContactLink link(channel, loop.coupling(), loop.center());
  std::vector<Sample> samples;
  device.start();
  for (std::int64_t i = 0; static_cast<double>(i) * kPeriod < seconds; ++i) {
    const std::int64_t now = i * kPeriodNs;
    servo.tick(now);
    PenSample pen;
    link.read(pen);
    const TickReport& report = loop.step(pen.state.pose, kPeriod);
    link.publish(report.proxy, static_cast<std::uint64_t>(i), pen.state.sequence, now);
    Sample s;
    s.t = static_cast<double>(i) * kPeriod;
    s.X = report.proxy.X;
    s.Y = pen.state.pose;
    s.center = s.X * loop.center();
    s.pen = pen.state.velocity;
    s.wrench = pen.wrench;
    s.contacts = report.contacts;
    s.held_back = report.unexplained_lag_ticks;
    samples.push_back(s);
    if (done && done(s)) break;
    if (op) op->see(s.t, s.X);
    device.advance(kPeriod);
  }
  device.stop();
  unexplained_lag_ticks() += loop.report().unexplained_lag_ticks;
  return samples;
}

std::atomic<std::int64_t>& unexplained_lag_ticks() {
  static std::atomic<std::int64_t> ticks{0};
  return ticks;
}

std::vector<std::string> resolvers() {
  return resolver_names();
}

std::int64_t count_intersecting(const Scene& scene, const std::vector<Sample>& samples, std::size_t most) {
  PoseCheck check;
  const std::size_t stride = samples.size() / most + 1;
  for (std::size_t i = 0; i < samples.size(); i += stride) check.add(samples[i].X);
  return check.count_intersecting(scene);
}

}  // namespace tegotae::experiments
