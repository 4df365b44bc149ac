#include "servo/safety_chain.hpp"

#include <cmath>

#include "tegotae/core/error.hpp"

namespace tegotae {

namespace {

// A heartbeat that may be older would keep a force that nobody updates for longer than a hand takes to notice.
constexpr double kLongestHeartbeatTimeout = 1.0;

/// Whether `a` and `b` differ by more than `limit`; a heartbeat of garbage may make the difference overflow.
bool apart(std::int64_t a, std::int64_t b, std::int64_t limit) {
  std::int64_t difference;
  return __builtin_sub_overflow(a, b, &difference) || difference > limit || difference < -limit;
}

bool finite(const Wrench& w) {
  return w.force.allFinite() && w.torque.allFinite();
}

}  // namespace

SafetyChain::SafetyChain(const SafetySettings& settings) : limits_(settings.limits) {
  if (!(std::isfinite(limits_.force) && limits_.force >= 0)) throw Error("safety: the force limit is out of range");
  if (!(std::isfinite(limits_.torque) && limits_.torque >= 0)) throw Error("safety: the torque limit is out of range");
  if (!(settings.heartbeat_timeout > 0 && settings.heartbeat_timeout <= kLongestHeartbeatTimeout))
    throw Error("safety: heartbeat_timeout must be above 0 and at most 1 s");
  timeout_ns_ = std::llround(settings.heartbeat_timeout * 1e9);
}

SafetyOutput SafetyChain::apply(const SafetyInput& in) noexcept {
  if (in.device_status != DeviceStatus::enabled)
    return {{}, in.device_reason == ForceOff::none ? ForceOff::software : in.device_reason};
  if (!in.attached) return {{}, ForceOff::software};
  // A heartbeat from the future is no better than an old one.
  if (apart(in.now_ns, in.heartbeat_ns, timeout_ns_)) return {{}, ForceOff::watchdog};
  if (!finite(in.wanted)) return {{}, ForceOff::not_finite};
  return {saturated(in.wanted, limits_), ForceOff::none};
}

}  // namespace tegotae
