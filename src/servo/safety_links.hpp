#pragma once

#include <cstdint>

#include "tegotae/servo/safety.hpp"

namespace tegotae {

/// Whether both times are at most `limit` apart; times of garbage may make the difference overflow.
bool within(std::int64_t a, std::int64_t b, std::int64_t limit) noexcept;
bool finite(const Wrench& w) noexcept;

/// 1 inside the workspace, 0 farther than the margin outside of it, linear between.
double workspace_gain(const SafetySettings& settings, const Vec3& pen) noexcept;

/// Lets a wrench change no faster than the slew limits; force and torque keep pace with each other.
class SlewLimit {
 public:
  explicit SlewLimit(const WrenchLimits& rate) : rate_(rate) {}
  /// The wrench nearest to `target` that is allowed `dt` seconds after the last one.
  Wrench apply(const Wrench& target, double dt) noexcept;
  void reset() noexcept { last_ = {}; }
  const Wrench& last() const noexcept { return last_; }

 private:
  WrenchLimits rate_;
  Wrench last_;
};

/// Keeps the running RMS of the force at what the motors can sustain. Its square m follows |F|² with the time
/// constant; the allowed peak P shrinks with it, P² = peak² - (peak² - c²) m / c², so that m settles at c² and never
/// exceeds it, and nothing jumps.
class ThermalBudget {
 public:
  explicit ThermalBudget(const SafetySettings& settings)
      : peak2_(settings.limits.force * settings.limits.force),
        continuous2_(settings.continuous_force * settings.continuous_force),
        time_(settings.thermal_time) {}
  /// The largest force allowed now, N.
  double allowed() const noexcept;
  void add(double force, double dt) noexcept;
  /// Running RMS over the continuous figure; 0 when not limited.
  double load() const noexcept;

 private:
  double peak2_, continuous2_, time_;
  double mean2_ = 0;
};

/// Turns the force on and off without a jump. Off: fades to nothing, always all the way, and says why. On: waits until
/// the wanted wrench has been small for a while, then ramps in.
class ForceGate {
 public:
  explicit ForceGate(const SafetySettings& settings) : settings_(settings) {}
  /// The part of the wrench that may leave, in [0, 1]. `off`: why the force must be off now, or none.
  double update(ForceOff off, const Wrench& wanted, double dt) noexcept;
  /// Off at once.
  void shut_off(ForceOff off) noexcept;
  ForceOff reason() const noexcept { return reason_; }
  double gain() const noexcept { return gain_; }

 private:
  SafetySettings settings_;
  ForceOff reason_ = ForceOff::software;
  double gain_ = 0;
  double small_for_ = 0;  // s
};

/// Notices a pen that has no new sample, and one that moves too fast (by what it says or by how far it came).
class PenWatch {
 public:
  explicit PenWatch(const SafetySettings& settings);
  /// To be called with each finite state; `moved` is the way of the pen's center since the last call.
  void update(const DeviceState& pen, const Displacement& moved, std::int64_t now_ns) noexcept;
  bool silent() const noexcept { return silent_; }
  bool fast() const noexcept { return fast_; }

 private:
  SafetySettings settings_;
  std::int64_t timeout_ns_;
  bool started_ = false;
  std::uint64_t sequence_ = 0;
  std::int64_t sampled_ns_ = 0;  // the sample's own time
  std::int64_t heard_ns_ = 0;    // when a new sample was seen
  bool silent_ = false;
  bool fast_ = false;
};

}  // namespace tegotae
