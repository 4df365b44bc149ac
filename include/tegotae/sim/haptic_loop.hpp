#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "tegotae/contact/contact.hpp"
#include "tegotae/core/export.hpp"
#include "tegotae/coupling/contact_planes.hpp"
#include "tegotae/coupling/coupling.hpp"
#include "tegotae/resolve/status.hpp"
#include "tegotae/sim/scene.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// What one tick of the contact loop did.
struct TickReport {
  std::vector<Pose> pieces;  ///< the free poses that X went through, in order; the last one is X (never empty)
  ProxyState proxy;          ///< X, its velocity, and whether it touches
  ContactPlanes planes;      ///< for a servo that brings X up to date between two ticks
  int contacts = 0;          ///< feature pairs with a gap of at most contact_gap
  double contact_gap = 0;    ///< what counts as contact in this tick, m
  int limits = 0;            ///< feature pairs that limited the motion, contacts included
  double gap = 0;            ///< smallest known gap, m; +inf when nothing is within reach; negative where penetrating
  double depth = 0;          ///< of the vertex that is deepest inside another part, m; only "penalty" penetrates
  int candidate_parts = 0;   ///< fixed parts that passed the broad phase
  int resolves = 0;          ///< programmes solved (penalty: Newton steps)
  int iterations = 0;        ///< pivots of all programmes (impulse: impulses)
  ResolveStatus status = ResolveStatus::not_needed;  ///< of the last programme or step of the tick
  double fraction = 1;                               ///< part of the wanted motion made, in [0, 1]
  bool cut = false;                                  ///< time or work ran out before the wanted motion was decided
  bool overflow = false;                             ///< a capacity was exceeded; the motion is still free
};

/// The contact loop: follows the pen with the held part so that no two parts ever intersect.
class HapticLoop {
 public:
  /// Builds everything a tick needs. Throws Error when the scene cannot be held: not exactly one held part, an unusable
  /// setting, an unknown resolver, or parts that intersect at the start (the message names the pair and the number of
  /// intersecting triangle pairs).
  explicit HapticLoop(const Scene& scene);
  ~HapticLoop();
  HapticLoop(const HapticLoop&) = delete;
  HapticLoop& operator=(const HapticLoop&) = delete;

  /// One tick: `Y` is where the pen wants the held part's file frame, `dt` the time since the last tick (s). Never
  /// throws; a pose that is not finite is ignored (X stays). The report is valid until the next call.
  const TickReport& step(const Pose& Y, double dt) noexcept;

  /// Of the last step(); before the first one, of the start.
  const TickReport& report() const;
  /// The nearest-feature pairs that limited the last tick's motion, as they are at X (at the pose before the last piece
  /// when the tick was cut). Valid until the next call of step().
  const std::vector<Contact>& limits() const;
  const Vec3& center() const;              ///< center of mass of the held part, m, file frame
  Mat3 gyration() const;                   ///< its inertia over its mass about that center, m², file axes
  const ContactSettings& contact() const;  ///< the settings in use, nothing left open

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tegotae
