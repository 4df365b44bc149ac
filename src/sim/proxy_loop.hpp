#pragma once

#include <memory>
#include <vector>

#include "tegotae/contact/contact.hpp"
#include "tegotae/mesh/mass.hpp"
#include "tegotae/sim/haptic_loop.hpp"

namespace tegotae {

/// What turns the pen's pose into the held part's, tick by tick: one implementation a family of resolvers.
class ProxyLoop {
 public:
  virtual ~ProxyLoop() = default;
  /// See HapticLoop::step; `Y` is finite and its quaternion of unit length.
  virtual void step(const Pose& Y, double dt, TickReport& report) = 0;
  virtual const Pose& pose() const = 0;
  /// See HapticLoop::limits.
  virtual const std::vector<Contact>& limits() const = 0;
  /// See HapticLoop::start.
  virtual const StartReport& start() const = 0;
};

/// The loop of `settings.resolver` (completed settings) over a scene with one held part. Throws Error for an unknown
/// name and for a start that is not free.
std::unique_ptr<ProxyLoop> make_proxy_loop(const Scene& scene, const ContactSettings& settings,
                                           const MassProperties& mass);

}  // namespace tegotae
