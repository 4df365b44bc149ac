#include "servo/servo_tick.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/valid_pose.hpp"
#include "servo/application_state.hpp"
#include "tegotae/coupling/stability.hpp"
#include "transport/shm_convert.hpp"

namespace tegotae {

static_assert(TEGOTAE_SHM_PLANES == ContactPlanes::kMax, "one number of planes");

namespace {

// Of the device's damping, what the observer counts on. With all of it the controller would leave just as much energy
// as comes in, and a swing would never die.
constexpr double kTrustedDamping = 0.5;

// Of the energy at which the force goes off as unstable, what the controller leaves to itself: contacts found and left
// and filtered velocities make a sixth of it. It is little, because a swing grows by so much before it is damped.
constexpr double kIdleShare = 0.005;

/// The chain's settings, no looser than the device's own limits.
SafetySettings within_device(SafetySettings s, const DeviceInfo& device) {
  check(s);
  s.limits.force = std::min(s.limits.force, device.limits.force);
  s.limits.torque = std::min(s.limits.torque, device.limits.torque);
  if (device.continuous_force > 0)
    s.continuous_force =
        s.continuous_force > 0 ? std::min(s.continuous_force, device.continuous_force) : device.continuous_force;
  return s;
}

PassivitySettings passivity_settings(const DeviceInfo& device, double bound) {
  PassivitySettings s;
  s.device_damping = kTrustedDamping * device.damping;
  s.device_torsional_damping = kTrustedDamping * device.torsional_damping;
  s.idle = kIdleShare * bound;
  return s;
}

bool loads(const Wrench& load) {
  return !load.force.isZero() || !load.torque.isZero();
}

/// 0 stands for a limit that is not known.
double known(std::optional<double> limit) {
  return limit && std::isfinite(*limit) ? *limit : 0;
}

}  // namespace

ServoTick::ServoTick(Device& device, Channel& channel, const ServoSettings& settings)
    : device_(device),
      channel_(channel),
      settings_(settings),
      info_(device.info()),
      safety_(within_device(settings.safety, info_)),
      chain_(safety_),
      watch_(safety_),
      mapping_(settings.mapping),
      passivity_(passivity_settings(info_, safety_.energy_bound)) {}

void ServoTick::read_application() noexcept {
  if (!channel_.read(application_)) return;
  attached_ = true;
  valid_ = valid(application_);
  // What cannot be leaves the last mapping in force; the safety chain turns the wrench off.
  if (!valid_) return;
  coupling_ = coupling_of(application_);
  command_ = mapping_of(application_);
  if (held_center_ == command_.center) return;
  held_center_ = command_.center;
  device_.set_held_center(command_.center);
}

void ServoTick::report_tracking_error(std::int64_t now_ns) noexcept {
  if (!attached_ || !valid_ || !started_ || !chain_.alive(application_.heartbeat_ns, now_ns)) return;
  Displacement error = displacement(proxy_of(application_).X, mapping_.Y(), command_.center);
  error.dp /= mapping_.scale();  // in the pen's meters
  device_.set_tracking_error(error);
}

void ServoTick::follow_pen(const DeviceState& pen, SafetyInput& in) noexcept {
  moved_ = {};
  in.pen_valid = is_valid(pen.pose) && pen.velocity.v.allFinite() && pen.velocity.w.allFinite();
  if (!in.pen_valid) return;
  if (started_) moved_ = displacement(pen_, pen.pose, device_.reference_point());
  started_ = true;
  pen_ = pen.pose;
  if (!attached_) command_.center = device_.reference_point();
  in.remapped = mapping_.update(pen, device_.reference_point(), command_);
  in.clutched = mapping_.clutch() != Clutch::none;
  watch_.update(pen, moved_, in.now_ns);
  in.pen_silent = watch_.silent();
  in.pen_fast = watch_.fast();
  in.pen = pen.pose.p;
}

Wrench ServoTick::coupling(double& stored) noexcept {
  ProxyState x = proxy_of(application_);
  const bool weighs = loads(x.load) && coupling_.stiffness > 0;
  // The part is drawn to where its load stretches the springs to, and the hand feels how far that is from the pen.
  const Pose target = loaded(mapping_.Y(), command_.center, coupling_, mapping_.scale(), x.load);
  if (settings_.local_model && local_.update(planes_of(application_), coupling_radius(coupling_, mapping_.scale()),
                                             command_.center, target, mapping_.velocity(), x))
    flags_ |= TEGOTAE_SHM_FLAG_LOCAL;
  if (weighs && !x.touching) x.X = target;
  lift(x);
  stored = lifted_;
  if (!x.touching && !weighs) return {};
  // The hand feels the set stiffness whatever the scale: lengths of the world are as long as the pen's way to them.
  CouplingSettings felt = coupling_;
  felt.stiffness /= mapping_.scale();
  felt.damping /= mapping_.scale();
  const Displacement error = displacement(mapping_.Y(), x.X, command_.center);
  stored += 0.5 * (coupling_.stiffness * (error.dp / mapping_.scale()).squaredNorm() +
                   coupling_.torsional_stiffness * error.dr.squaredNorm());
  return coupling_wrench(felt, x, mapping_.Y(), mapping_.velocity(), command_.center);
}

void ServoTick::lift(const ProxyState& x) noexcept {
  const bool was_carried = carries_;
  carries_ = loads(x.load);
  if (was_carried && carries_) {
    const Displacement gone = displacement(carried_at_, x.X, command_.center);
    lifted_ -= x.load.force.dot(gone.dp) / mapping_.scale() + x.load.torque.dot(gone.dr);
  }
  // What is lifted is told by the way alone: a load that comes and goes, or another part, gives no energy.
  if (!carries_) lifted_ = 0;
  carried_at_ = x.X;
}

void ServoTick::run(std::int64_t now_ns) noexcept TEGOTAE_NONBLOCKING {
  SafetyInput in;
  in.now_ns = now_ns;
  in.dt = ticks_ == 0 ? 1.0 / settings_.rate_hz : 1e-9 * static_cast<double>(now_ns - last_ns_);
  flags_ = 0;
  read_application();
  report_tracking_error(now_ns);
  const DeviceState pen = device_.read();
  follow_pen(pen, in);

  double stored = 0;
  if (attached_ && valid_ && in.pen_valid) in.wanted = coupling(stored);
  passivity_.observe(moved_, rendered_, stored, unmodified_, in.dt,
                     steps_.energy(moved_, coupling_, info_.position_resolution, in.dt));
  if (safety_.passivity_control && (stored > 0 || carries_) && passivity_.acts() && coupling_.stiffness > 0) {
    const Wrench damping = passivity_.controller(coupling_.torsional_stiffness / coupling_.stiffness);
    in.wanted.force += damping.force;
    in.wanted.torque += damping.torque;
    flags_ |= TEGOTAE_SHM_FLAG_DAMPED;
  }

  in.device_status = device_.status();
  in.device_reason = device_.reason();
  in.force_freedom = info_.force_freedom;
  in.buttons = pen.buttons;
  in.attached = attached_;
  in.force_asked = application_.enable != 0;
  in.valid = valid_;
  in.energy = passivity_.energy();
  in.heartbeat_ns = application_.heartbeat_ns;
  const SafetyOutput out = chain_.apply(in);
  device_.write(out.wrench);
  rendered_ = out.wrench;
  unmodified_ = out.unmodified;
  // What was generated before is settled when the force is off.
  if (out.reason != ForceOff::none) passivity_.reset();
  if (out.reason != reason_ && out.reason != ForceOff::none) ++force_off_[static_cast<std::size_t>(out.reason)];
  reason_ = out.reason;
  publish(pen, out, now_ns);
  last_ns_ = now_ns;
  ++ticks_;
}

void ServoTick::describe_device(tegotae_shm_device& out) const noexcept {
  out.motion_freedom = static_cast<std::uint32_t>(info_.motion_freedom);
  out.force_freedom = static_cast<std::uint32_t>(info_.force_freedom);
  std::memcpy(out.name, info_.name.data(), std::min<std::size_t>(info_.name.size(), TEGOTAE_SHM_NAME - 1));
  out.force_limit = safety_.limits.force;
  out.torque_limit = safety_.limits.torque;
  out.continuous_force = safety_.continuous_force;
  const StabilityReport limits = stability(info_, coupling_, settings_.rate_hz);
  out.stiffness_limit = known(limits.stiffness_limit);
  out.torsional_stiffness_limit = known(limits.torsional_stiffness_limit);
}

void ServoTick::publish(const DeviceState& pen, const SafetyOutput& rendered, std::int64_t now_ns) noexcept {
  const bool on = rendered.reason == ForceOff::none;
  const DeviceStatus status = on ? DeviceStatus::enabled : std::min(device_.status(), DeviceStatus::ready);
  tegotae_shm_device out{};
  out.heartbeat_ns = now_ns;
  out.tick = ticks_;
  out.time_ns = pen.time_ns;
  out.sequence = pen.sequence;
  out.status = static_cast<std::uint32_t>(status);
  out.reason = static_cast<std::uint32_t>(rendered.reason);
  out.buttons = pen.buttons;
  out.flags = rendered.flags | (on ? flags_ : 0);
  store(mapping_.Y().p, out.position);
  store(mapping_.Y().q, out.orientation);
  store(mapping_.velocity().v, out.velocity);
  store(mapping_.velocity().w, out.angular_velocity);
  store(rendered.wrench.force, out.force);
  store(rendered.wrench.torque, out.torque);
  store(pen_.p, out.raw_position);
  store(pen_.q, out.raw_orientation);
  out.scale = mapping_.scale();
  out.clutch = static_cast<std::uint32_t>(mapping_.clutch());
  out.home_counter = mapping_.home_counter();
  out.thermal_load = chain_.thermal_load();
  out.energy = passivity_.energy();
  out.attachment = application_.attachment;
  describe_device(out);
  channel_.write(out);
}

}  // namespace tegotae
