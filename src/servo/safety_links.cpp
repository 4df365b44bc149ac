#include "servo/safety_links.hpp"

#include <algorithm>
#include <cmath>

namespace tegotae {

namespace {

// Two samples whose time stamps are nearer are taken to be this far apart (s): a driver's stamps jitter, and a way
// divided by next to nothing is not a velocity.
constexpr double kMinInterval = 1e-4;

}  // namespace

bool within(std::int64_t a, std::int64_t b, std::int64_t limit) noexcept {
  std::int64_t difference;
  return !__builtin_sub_overflow(a, b, &difference) && difference <= limit && difference >= -limit;
}

bool finite(const Wrench& w) noexcept {
  return w.force.allFinite() && w.torque.allFinite();
}

double workspace_gain(const SafetySettings& settings, const Vec3& pen) noexcept {
  const Vec3 outside = ((pen - settings.workspace_center).cwiseAbs() - settings.workspace_half).cwiseMax(0.0);
  const double gain = 1 - outside.norm() / settings.workspace_margin;
  return gain > 0 ? std::min(gain, 1.0) : 0;
}

Wrench SlewLimit::apply(const Wrench& target, double dt) noexcept {
  const Wrench change = {target.force - last_.force, target.torque - last_.torque};
  // The same factor for both, as in saturated(): neither outruns the other.
  const Wrench allowed = saturated(change, {rate_.force * dt, rate_.torque * dt});
  last_ = {last_.force + allowed.force, last_.torque + allowed.torque};
  if (allowed.force == change.force && allowed.torque == change.torque) last_ = target;
  return last_;
}

double ThermalBudget::allowed() const noexcept {
  if (continuous2_ <= 0) return std::sqrt(peak2_);
  const double used = std::min(mean2_ / continuous2_, 1.0);
  return std::sqrt(peak2_ - std::max(peak2_ - continuous2_, 0.0) * used);
}

void ThermalBudget::add(double force, double dt) noexcept {
  mean2_ += (force * force - mean2_) * -std::expm1(-dt / time_);
}

double ThermalBudget::load() const noexcept {
  return continuous2_ > 0 ? std::sqrt(mean2_ / continuous2_) : 0;
}

void ForceGate::shut_off(ForceOff off) noexcept {
  reason_ = off;
  gain_ = 0;
  small_for_ = 0;
}

double ForceGate::update(ForceOff off, const Wrench& wanted, double dt) noexcept {
  const bool was_on = reason_ == ForceOff::none;
  if (was_on && off != ForceOff::none) reason_ = off;
  if (reason_ == ForceOff::none) {
    gain_ = std::min(1.0, gain_ + dt / settings_.ramp_time);
    return gain_;
  }
  if (gain_ > 0) {
    // Once on its way out it goes all the way, whatever happened to the cause.
    gain_ = std::max(0.0, gain_ - dt / settings_.fade_time);
    // Rounding must not cost another tick.
    if (gain_ < 1e-9) gain_ = 0;
    small_for_ = 0;
    return gain_;
  }
  reason_ = off == ForceOff::none ? ForceOff::engage : off;
  const bool small = wanted.force.norm() < settings_.engage.force && wanted.torque.norm() < settings_.engage.torque;
  small_for_ = off == ForceOff::none && small ? small_for_ + dt : 0;
  if (small_for_ >= settings_.engage_time) {
    reason_ = ForceOff::none;
    small_for_ = 0;
  }
  return gain_;
}

PenWatch::PenWatch(const SafetySettings& settings)
    : settings_(settings), timeout_ns_(std::llround(settings.silence_timeout * 1e9)) {}

void PenWatch::update(const DeviceState& pen, const Displacement& moved, std::int64_t now_ns) noexcept {
  const bool fresh = !started_ || pen.sequence != sequence_;
  fast_ = !(pen.velocity.v.norm() <= settings_.velocity_limit) ||
          !(pen.velocity.w.norm() <= settings_.angular_velocity_limit);
  if (fresh) {
    if (started_) {
      const double interval =
          std::max(1e-9 * (static_cast<double>(pen.time_ns) - static_cast<double>(sampled_ns_)), kMinInterval);
      fast_ |= moved.dp.norm() > settings_.velocity_limit * interval ||
               moved.dr.norm() > settings_.angular_velocity_limit * interval;
    }
    started_ = true;
    sequence_ = pen.sequence;
    sampled_ns_ = pen.time_ns;
    heard_ns_ = now_ns;
  }
  silent_ = !within(now_ns, heard_ns_, timeout_ns_);
}

}  // namespace tegotae
