#include "servo/safety_chain.hpp"

#include <algorithm>
#include <cmath>

#include "tegotae/core/error.hpp"

namespace tegotae {

namespace {

// Of what is counted for one tick (s), so that a servo that was held up does not make up for it in one step.
constexpr double kLongestStep = 0.005;

void require(bool good, const char* setting, const char* range) {
  if (!good)
    throw Error(ErrorKind::setting, std::string("safety: ") + setting + " must be " + range, {{}, 0, setting, {}});
}

bool not_negative(double x) {
  return std::isfinite(x) && x >= 0;
}
bool positive(double x) {
  return std::isfinite(x) && x > 0;
}

Wrench operator*(double s, const Wrench& w) {
  return {s * w.force, s * w.torque};
}

}  // namespace

void check(const SafetySettings& s) {
  require(not_negative(s.limits.force), "the force limit", "at least 0 N");
  require(not_negative(s.limits.torque), "the torque limit", "at least 0 N·m");
  const auto timeout = [](double t) { return t > 0 && t <= kMaxTimeout; };
  require(timeout(s.heartbeat_timeout), "heartbeat_timeout", "above 0 and at most 1 s");
  require(timeout(s.silence_timeout), "silence_timeout", "above 0 and at most 1 s");
  require(timeout(s.fade_time), "fade_time", "above 0 and at most 1 s");
  require(positive(s.ramp_time), "ramp_time", "above 0 s");
  require(positive(s.engage.force), "the engage force", "above 0 N");
  require(positive(s.engage.torque), "the engage torque", "above 0 N·m");
  require(not_negative(s.engage_time), "engage_time", "at least 0 s");
  require(positive(s.slew.force), "the slew limit of the force", "above 0 N/s");
  require(positive(s.slew.torque), "the slew limit of the torque", "above 0 N·m/s");
  require(positive(s.velocity_limit), "velocity_limit", "above 0 m/s");
  require(positive(s.angular_velocity_limit), "angular_velocity_limit", "above 0 rad/s");
  require(not_negative(s.continuous_force), "continuous_force", "at least 0 N");
  require(positive(s.thermal_time), "thermal_time", "above 0 s");
  require(s.workspace_center.allFinite(), "workspace_center", "finite");
  require(s.workspace_half.minCoeff() > 0, "workspace_half", "above 0 m");
  require(positive(s.workspace_margin), "workspace_margin", "above 0 m");
  require(positive(s.energy_bound), "energy_bound", "above 0 J");
}

SafetyChain::SafetyChain(const SafetySettings& settings)
    : settings_((check(settings), settings)),
      timeout_ns_(std::llround(settings.heartbeat_timeout * 1e9)),
      thermal_(settings),
      gate_(settings),
      slew_(settings.slew) {}

bool SafetyChain::alive(std::int64_t heartbeat_ns, std::int64_t now_ns) const noexcept {
  return within(now_ns, heartbeat_ns, timeout_ns_);
}

ForceOff SafetyChain::emergency(const SafetyInput& in) const noexcept {
  if (in.device_status != DeviceStatus::enabled)
    return in.device_reason == ForceOff::none ? ForceOff::software : in.device_reason;
  if (!in.pen_valid) return ForceOff::not_finite;
  if (in.attached && (!in.valid || !finite(in.wanted))) return ForceOff::not_finite;
  return ForceOff::none;
}

ForceOff SafetyChain::off(const SafetyInput& in, double workspace) const noexcept {
  if (in.force_freedom == 0) return ForceOff::no_force;
  if (in.pen_silent) return ForceOff::silent;
  if (settings_.dead_man_buttons != 0 && (in.buttons & settings_.dead_man_buttons) == 0) return ForceOff::dead_man;
  if (!in.attached || !in.force_asked) return ForceOff::software;
  if (!alive(in.heartbeat_ns, in.now_ns)) return ForceOff::watchdog;
  if (in.clutched) return ForceOff::clutched;
  if (in.remapped) return ForceOff::engage;
  if (in.pen_fast) return ForceOff::velocity;
  if (workspace <= 0) return ForceOff::workspace;
  if (in.energy < -settings_.energy_bound) return ForceOff::energy;
  return ForceOff::none;
}

SafetyOutput SafetyChain::apply(const SafetyInput& in) noexcept {
  const double dt = std::clamp(in.dt, 0.0, kLongestStep);
  if (const ForceOff now = emergency(in); now != ForceOff::none) {
    gate_.shut_off(now);
    slew_.reset();
    shaped_ = {};
    thermal_.add(0, dt);
    return {{}, now, 0, false};
  }
  const double workspace = workspace_gain(settings_, in.pen);
  const ForceOff must_off = off(in, workspace);
  SafetyOutput out;
  const double gain = gate_.update(must_off, in.wanted, dt);
  out.reason = gate_.reason();
  if (out.reason == ForceOff::none) {
    const auto flag = [&out](bool set, std::uint32_t bit) { out.flags |= set ? bit : 0; };
    const Wrench within_peak = saturated(in.wanted, settings_.limits);
    flag(within_peak.force != in.wanted.force || within_peak.torque != in.wanted.torque, TEGOTAE_SHM_FLAG_SATURATED);
    const WrenchLimits budget = {std::min(thermal_.allowed(), settings_.limits.force), settings_.limits.torque};
    const Wrench within_budget = saturated(within_peak, budget);
    flag(within_budget.force != within_peak.force, TEGOTAE_SHM_FLAG_THERMAL);
    flag(workspace < 1, TEGOTAE_SHM_FLAG_WORKSPACE);
    flag(gain < 1, TEGOTAE_SHM_FLAG_RAMP);
    shaped_ = workspace < 1 ? workspace * within_budget : within_budget;
  }
  const Wrench target = gain < 1 ? gain * shaped_ : shaped_;
  const Wrench slewed = slew_.apply(target, dt);
  if (slewed.force != target.force || slewed.torque != target.torque) out.flags |= TEGOTAE_SHM_FLAG_SLEW;
  out.wrench = slewed;
  out.unmodified = out.reason == ForceOff::none && out.flags == 0;
  thermal_.add(slewed.force.norm(), dt);
  return out;
}

}  // namespace tegotae
