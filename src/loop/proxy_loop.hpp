#pragma once

#include <memory>
#include <vector>

#include "tegotae/contact/contact.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/mesh/mass.hpp"

namespace tegotae {

/// Sub-steps for which a report has capacity; no loop makes more in a tick.
inline constexpr std::size_t kMaxSubsteps = 1024;

/// The report of a tick that has not done anything: its owner calls this before each tick, so that nothing is left of
/// an earlier tick, resolver or scene. Keeps the capacity of `substeps`.
void reset(TickReport& report) noexcept;

/// What turns the pen's pose into the held part's, tick by tick: one implementation a family of resolvers.
class ProxyLoop {
 public:
  virtual ~ProxyLoop() = default;
  /// See HapticLoop::step; `Y` is proper and `dt` finite and not negative. What is not done at `deadline_ns` of
  /// monotonic_ns() is left. `report` is as reset() leaves it: whatever this loop does not set says that nothing was.
  virtual void step(const Pose& Y, double dt, std::int64_t deadline_ns, TickReport& report) = 0;
  /// Goes on from a loop over another scene with the same held part, whose last tick was `last`, for the pen at `Y`.
  /// False, and nothing happens, when the way there from this loop's own pose is not known by `deadline_ns` to be free
  /// of the parts that are `fresh` (by number of the fixed parts; null: of all).
  virtual bool take_over(const TickReport& last, const Pose& Y, const std::vector<bool>* fresh,
                         std::int64_t deadline_ns) = 0;
  virtual const Pose& pose() const = 0;
  /// See HapticLoop::constraints.
  virtual const std::vector<Contact>& constraints() const = 0;
  /// See HapticLoop::start.
  virtual const InitialContactReport& start() const = 0;
};

/// The loop of `settings.resolver` (completed settings) over a scene with one held part. Throws Error
/// for a start that is not free.
std::unique_ptr<ProxyLoop> make_proxy_loop(const Scene& scene, const ContactSettings& settings,
                                           const MassProperties& mass);

}  // namespace tegotae
