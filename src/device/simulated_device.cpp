#include "tegotae/device/simulated_device.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "device/pen_body.hpp"
#include "device/script_hand.hpp"
#include "device/velocity_filter.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

namespace {

// Longest step of the body's integration: 1/50 of the shortest time scale in use (a grip of 1.5 N·m/rad on the bare pen
// swings at 200 rad/s), where the midpoint rule is off by 3e-5 of the phase.
constexpr std::int64_t kMaxStepNs = 100'000;

// A servo that was held up for longer does not find the hand far away: the script waits.
constexpr std::int64_t kMaxCatchUpNs = 50'000'000;

// How a led hand moves: it lags by this time (s), which smooths the steps in which a mouse reports, and is never faster
// than this (m/s, rad/s), so that a jump of the mouse is a motion of the hand.
constexpr double kHandLag = 0.03, kHandSpeed = 0.4, kHandTurning = 6.0;

void require(bool good, const char* setting) {
  if (!good)
    throw Error(ErrorKind::setting, std::string("simulated device: ") + setting + " is out of range",
                {{}, 0, setting, {}});
}

bool positive(double x) {
  return std::isfinite(x) && x > 0;
}
bool not_negative(double x) {
  return std::isfinite(x) && x >= 0;
}

void check(const SimulatedDeviceSettings& s) {
  require(not_negative(s.hand.stiffness), "hand stiffness");
  require(not_negative(s.hand.damping), "hand damping");
  require(not_negative(s.hand.torsional_stiffness), "hand torsional_stiffness");
  require(not_negative(s.hand.torsional_damping), "hand torsional_damping");
  require(not_negative(s.hand.mass), "hand mass");
  require(not_negative(s.hand.inertia), "hand inertia");
  require(positive(s.mass), "mass");
  require(s.inertia.allFinite() && s.inertia.minCoeff() > 0, "inertia");
  require(not_negative(s.friction), "friction");
  require(not_negative(s.limits.force), "force limit");
  require(not_negative(s.limits.torque), "torque limit");
  require(not_negative(s.position_resolution), "position_resolution");
  require(not_negative(s.rotation_resolution), "rotation_resolution");
  require(positive(s.velocity_cutoff_hz), "velocity_cutoff_hz");
}

PenBodySettings body_settings(const SimulatedDeviceSettings& s) {
  return {s.mass + s.hand.mass,
          s.inertia + Vec3::Constant(s.hand.inertia),
          s.hand.stiffness,
          s.hand.damping,
          s.hand.torsional_stiffness,
          s.hand.torsional_damping,
          s.friction};
}

Vec3 at_most(const Vec3& value, double norm) {
  const double n = value.norm();
  return n > norm ? Vec3((norm / n) * value) : value;
}

Vec3 rounded(const Vec3& value, double resolution) {
  if (resolution == 0) return value;
  return resolution * (value / resolution).array().round().matrix();
}

}  // namespace

struct SimulatedDevice::Impl {
  Impl(const SimulatedDeviceSettings& settings_in, InputSource& hand_in, std::unique_ptr<InputSource> owned_in)
      : settings(settings_in),
        owned(std::move(owned_in)),
        hand(hand_in),
        body_constants(body_settings(settings)),
        velocity(settings.velocity_cutoff_hz, settings.position_resolution, settings.rotation_resolution) {}

  static std::unique_ptr<Impl> with(const SimulatedDeviceSettings& settings, std::unique_ptr<InputSource> hand) {
    InputSource& it = *hand;
    return std::make_unique<Impl>(settings, it, std::move(hand));
  }

  SimulatedDeviceSettings settings;
  std::unique_ptr<InputSource> owned;  // null when the caller owns the hand
  InputSource& hand;
  PenBodySettings body_constants;
  PenBody body;
  Vec3 center = Vec3::Zero();            // of mass of the held part, file frame
  Quat encoder_zero = Quat::Identity();  // rotations are counted from where the pen started
  Wrench rendered;
  std::atomic<std::int64_t> time_ns{0};  // since the script's begin; atomic for script_time()
  std::int64_t last_read_clock_ns = -1;  // wall clock
  bool waiting = settings.wait_for_application;
  DeviceStatus status = DeviceStatus::uninitialized;

  // What was read last.
  Vec3 sampled_center = Vec3::Zero();
  Quat sampled_rotation = Quat::Identity();
  VelocityFilter velocity;
  std::uint64_t sequence = 0;

  const InputGuide* guide = nullptr;
  bool led = false;     // by the guide; until then the hand goes where it wants
  Pose goal, led_hand;  // where the guide leads, and where the led hand is
  Twist led_rate;       // `v` of the file frame

  double script_time(std::int64_t ns) const { return hand.begin() + 1e-9 * static_cast<double>(ns); }

  HandTarget intent(double t) { return hand.target(t, {body.rotation, body.center - body.rotation * center}); }

  void poll_guide() {
    if (!guide || !guide->target(goal) || led) return;
    led = true;
    led_hand = intent(script_time(time_ns.load(std::memory_order_relaxed))).pose;
  }

  void move_hand(double h) {
    const Displacement way = displacement(led_hand, goal, center);
    const double rate = 1 / (kHandLag + h);
    const Twist of_center = {at_most(rate * way.dp, kHandSpeed), at_most(rate * way.dr, kHandTurning)};
    led_hand = displaced(led_hand, center, h * Displacement{of_center.v, of_center.w});
    led_rate = {of_center.v - of_center.w.cross(led_hand.q * center), of_center.w};
  }

  PenTarget target(double t) {
    const auto [pose, rate] = led ? HandTarget{led_hand, led_rate} : intent(t);
    const Vec3 arm = pose.q * center;
    return {pose.p + arm, pose.q, {rate.v + rate.w.cross(arm), rate.w}};
  }

  void advance(std::int64_t dt_ns) {
    std::int64_t now = time_ns.load(std::memory_order_relaxed);
    const std::int64_t end = now + dt_ns;
    poll_guide();
    while (now < end) {
      const std::int64_t step = std::min(kMaxStepNs, end - now);
      const double h = 1e-9 * static_cast<double>(step);
      if (led) move_hand(h);
      body.step(h, body_constants, target(script_time(now) + 0.5 * h), rendered);
      now += step;
    }
    time_ns.store(now, std::memory_order_relaxed);
  }

  /// The encoders' view of the body, and the velocity that a driver would make of it.
  void sample() {
    sampled_center = rounded(body.center, settings.position_resolution);
    const Vec3 angles =
        rounded(rotation_vector(body.rotation * encoder_zero.conjugate()), settings.rotation_resolution);
    sampled_rotation = (rotation(angles) * encoder_zero).normalized();
    velocity.add(sampled_center, sampled_rotation, time_ns.load(std::memory_order_relaxed));
  }
};

SimulatedDevice::SimulatedDevice(std::unique_ptr<Impl> impl, const Vec3& center) : impl_(std::move(impl)) {
  check(impl_->settings);
  require(center.allFinite(), "center");
  impl_->center = center;
  const Pose start = impl_->hand.start();
  impl_->body.center = start * center;
  impl_->body.rotation = start.q;
  impl_->encoder_zero = start.q;
}

SimulatedDevice::SimulatedDevice(const SimulatedDeviceSettings& settings, StylusScript script, const Vec3& center)
    : SimulatedDevice(Impl::with(settings, std::make_unique<ScriptHand>(std::move(script))), center) {}

SimulatedDevice::SimulatedDevice(const SimulatedDeviceSettings& settings, InputSource& hand, const Vec3& center)
    : SimulatedDevice(std::make_unique<Impl>(settings, hand, nullptr), center) {}

SimulatedDevice::~SimulatedDevice() = default;

DeviceInfo device_info(const SimulatedDeviceSettings& s) {
  DeviceInfo info;
  info.name = "simulated";
  info.limits = s.limits;
  info.continuous_force = s.continuous_force;
  info.damping = s.hand.damping;
  info.torsional_damping = s.hand.torsional_damping;
  info.friction = s.friction;
  info.position_resolution = s.position_resolution;
  return info;
}

DeviceInfo SimulatedDevice::info() const {
  return device_info(impl_->settings);
}

void SimulatedDevice::start() {
  impl_->rendered = {};
  impl_->last_read_clock_ns = -1;
  impl_->status = DeviceStatus::enabled;
}

void SimulatedDevice::stop() {
  impl_->rendered = {};
  impl_->status = DeviceStatus::uninitialized;
}

DeviceState SimulatedDevice::read() noexcept {
  std::int64_t stamp = impl_->time_ns.load(std::memory_order_relaxed);
  if (impl_->settings.wall_clock) {
    stamp = monotonic_ns();
    if (impl_->last_read_clock_ns >= 0 && !impl_->waiting)
      impl_->advance(std::clamp<std::int64_t>(stamp - impl_->last_read_clock_ns, 0, kMaxCatchUpNs));
    impl_->last_read_clock_ns = stamp;
  }
  impl_->sample();
  const Quat& q = impl_->sampled_rotation;
  return {{q, impl_->sampled_center - q * impl_->center}, impl_->velocity.velocity(), 0, stamp, impl_->sequence++};
}

void SimulatedDevice::write(const Wrench& wrench) noexcept {
  impl_->rendered = impl_->status == DeviceStatus::enabled ? saturated(wrench, impl_->settings.limits) : Wrench{};
}

DeviceStatus SimulatedDevice::status() const noexcept {
  return impl_->status;
}

ForceOff SimulatedDevice::reason() const noexcept {
  return impl_->status == DeviceStatus::enabled ? ForceOff::none : ForceOff::software;
}

Vec3 SimulatedDevice::reference_point() const noexcept {
  return impl_->center;
}

void SimulatedDevice::set_held_center(const Vec3& center) noexcept {
  if (center == impl_->center) return;
  PenBody& body = impl_->body;
  const Vec3 arm = body.rotation * (center - impl_->center);
  body.center += arm;
  body.velocity += body.angular_velocity(impl_->body_constants).cross(arm);
  // The difference to the last sample would be a jump of the point, not a motion.
  impl_->velocity.forget();
  impl_->center = center;
}

void SimulatedDevice::follow(const InputGuide& guide) noexcept {
  impl_->guide = &guide;
}

void SimulatedDevice::set_tracking_error(const Displacement&) noexcept {
  impl_->waiting = false;
}

void SimulatedDevice::use_wall_clock(bool on) noexcept {
  impl_->settings.wall_clock = on;
}

void SimulatedDevice::advance(double dt) noexcept {
  if (dt > 0 && std::isfinite(dt)) impl_->advance(std::llround(dt * 1e9));
}

double SimulatedDevice::script_time() const noexcept {
  return impl_->script_time(impl_->time_ns.load(std::memory_order_relaxed));
}

Pose SimulatedDevice::true_pose() const noexcept {
  const PenBody& body = impl_->body;
  return {body.rotation, body.center - body.rotation * impl_->center};
}

Twist SimulatedDevice::true_velocity() const noexcept {
  return {impl_->body.velocity, impl_->body.angular_velocity(impl_->body_constants)};
}

}  // namespace tegotae
