#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tegotae/contact/contact.hpp"
#include "tegotae/contact/contact_point.hpp"
#include "tegotae/core/contact_force.hpp"
#include "tegotae/core/export.hpp"
#include "tegotae/core/lag_reason.hpp"
#include "tegotae/coupling/contact_planes.hpp"
#include "tegotae/coupling/coupling.hpp"
#include "tegotae/loop/initial_contacts.hpp"
#include "tegotae/loop/scene.hpp"
#include "tegotae/loop/scene_change.hpp"
#include "tegotae/resolve/status.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// What a tick met that its user may want to know.
struct TickFlags {
  bool timed_out = false;      ///< time or work ran out before the wanted motion was decided
  bool overflow = false;       ///< a capacity was exceeded; the motion is still free
  bool input_ignored = false;  ///< the pen's pose or the time was out of range (see HapticLoop::step) and left out
  bool scene_changed = false;  ///< it is the first tick in a changed scene
  bool part_changed = false;   ///< in which another part is held; the tick did not follow the pen
};

/// What one tick of the contact loop did.
struct TickReport {
  std::vector<Pose> pieces;  ///< the free poses that X went through, in order; the last one is X (never empty)
  ProxyState proxy;          ///< X, its velocity, and whether it touches
  ContactPlanes planes;      ///< for a servo that brings X up to date between two ticks
  /// What the contacts exert on the held part at the end of the tick: with `forces.lag` it is the wrench of the
  /// coupling's springs, k (X − Y) and k_t rotvec(R_X R_Yᵀ), less `proxy.load`, before the damper, the servo's newer
  /// Y and the safety chain. Of resolvers that project (Resolver::projects, "qp"), and only while it touches; of others
  /// none is available.
  ContactForces forces;
  int contacts = 0;         ///< feature pairs with a gap of at most contact_gap
  double contact_gap = 0;   ///< what counts as contact in this tick, m
  int constraints = 0;      ///< feature pairs that limited the motion, contacts included
  double gap = 0;           ///< smallest known gap, m; +inf when nothing is within reach; negative where penetrating
  double depth = 0;         ///< of the vertex that is deepest inside another part, m; only "penalty" penetrates
  int candidate_parts = 0;  ///< fixed parts that passed the broad phase
  int resolves = 0;         ///< programs solved (penalty: Newton steps)
  int iterations = 0;       ///< pivots of all programs (impulse: impulses)
  ResolveStatus status = ResolveStatus::not_needed;  ///< of the last program or step of the tick
  double fraction = 1;                               ///< part of the wanted motion made, in [0, 1]
  TickFlags flags;                                   ///< what it met
  int filtered = 0;  ///< pairs that overlapped at the start and have not come free: nothing keeps them apart
  int shrunk = 0;    ///< pairs that touched at the start and have not come free (InitialContact::relief)
  /// How far X is behind the pen after the tick: distance of the two centers of mass plus the held part's radius times
  /// the angle between them, m.
  double lag = 0;
  LagReason lag_reason = LagReason::none;  ///< why
  /// Ticks since the loop began in which X was held back without a contact that explains it: the lag was over
  /// kMaxUnexplainedLag (scaled, see lag_bound) for a reason other than contact, and the part came less far than that
  /// in the tick, as it had been in the kLagPatience ticks before without a break.
  std::int64_t unexplained_lag_ticks = 0;
};

/// The weight of the held part (Scene::weight).
struct HeldWeight {
  double mass = 0;            ///< kg, as given or by volume and density; 0: no weight is asked for
  double share = 1;           ///< of mass × gravity that the hand carries: below 1 where it is more than `most`
  Vec3 force = Vec3::Zero();  ///< N, world: share × mass × gravity
};

/// Lag (m) that needs a reason in contact, of a part with a radius of at least kLagRadius (m) about its center of mass;
/// a smaller part's is smaller in proportion.
inline constexpr double kMaxUnexplainedLag = 3e-4;
/// Radius (m) of a part from which on kMaxUnexplainedLag holds unscaled.
inline constexpr double kLagRadius = 0.03;
/// Ticks in a row for which a lag may be over that.
inline constexpr int kLagPatience = 20;
/// The bound (m) for a part of `radius` (m) about its center of mass: 0.3 mm, or 1 % of the radius where that is less.
constexpr double lag_bound(double radius) {
  return kMaxUnexplainedLag * (radius < kLagRadius ? radius / kLagRadius : 1.0);
}

/// The contact loop: follows the pen with the held part so that it never intersects a fixed part, but for pairs that
/// start() names.
class HapticLoop {
 public:
  /// Builds everything a tick needs. Throws Error when the scene cannot be held: not exactly one held part, a pose or
  /// setting that cannot be used, an unknown resolver, or parts that overlap at the start (the message names the pair,
  /// depth and place; see ContactSettings::initial_overlap). Where parts only touch, the held part may start a few
  /// micrometers beside its pose in the scene: see start().
  explicit HapticLoop(const Scene& scene);
  ~HapticLoop();
  HapticLoop(const HapticLoop&) = delete;
  HapticLoop& operator=(const HapticLoop&) = delete;

  /// One tick: `Y` is where the pen wants the held part's file frame, `dt` the time since the last tick (s). Never
  /// throws. The report is valid until the next call.
  ///
  /// Taken are poses that are finite, of unit length (within 5e-4) and no farther than 10 km from the origin in any
  /// coordinate; for another one the last pose that was taken stands in. Times are 0 (nothing has a velocity then) or
  /// from a microsecond on; for another one 0 stands in. TickFlags::input_ignored tells both.
  const TickReport& step(const Pose& Y, double dt) noexcept;

  /// How much of the weight the hand carries from the next tick on, from 0 (as it begins) to 1. Whoever sets it lets it
  /// grow over some 0.3 s once the force is on: the part sinks by weight / stiffness, and a force that jumped would be
  /// waited out by the safety chain.
  void carry(double share) noexcept;

  /// What else pulls at the held part from the next tick on, beside its weight: a wrench at its center of mass (world,
  /// N and N·m as the hand feels them), such as that of a guide. It goes with the proxy to the servo
  /// (ProxyState::load), which gives it to the hand. Zero when it is not finite, and when another part comes to be
  /// held. Whoever sets it keeps it small and lets it grow slowly, as for carry(). Call it in the thread of step().
  void pull(const Wrench& wrench) noexcept;

  /// Continues in another scene: parts are added, removed, hidden (left out), moved, or another one is held. May be
  /// called from any thread while step() runs; it builds here what is new (parts that share a mesh with the scene so
  /// far share its hierarchy), and step() goes over to it between two ticks, without waiting, allocating or freeing. A
  /// later change replaces an earlier one that is not in force yet. Nothing of the old scene's contacts is kept.
  ///
  /// `next` places the held part where it was lately (TickReport::proxy), and must be free of the others there. If it
  /// has gone on since, the straight way from there to where it is must be free of what was added or moved: until it
  /// is, the change waits and the old scene stays in force. A part that was not held before starts where `next` has it:
  /// the first tick with it does not follow the pen, so that the pen can be brought there first (ContactLink::home).
  ///
  /// `ready` is told the change's number and how the held part starts in it, in this thread and before step() may go
  /// over to it. Throws Error as the constructor does, and what `ready` throws; nothing changes then.
  SceneChange change(const Scene& next,
                     const std::function<void(std::uint64_t number, const InitialContactReport& start)>& ready = {});
  /// Number of the change that the last tick ran in, 0 before the first; from any thread.
  std::uint64_t change_in_force() const noexcept;

  /// Name of the part that is held in the scene in force; from any thread.
  std::string held() const;

  /// Where the held part was after the last tick; from any thread, to draw it and for change().
  Pose latest() const noexcept;

  /// Of the last step(); before the first one, of the start.
  const TickReport& report() const;
  /// What the held part touched or overlapped at the start, and what has become of it by the last tick.
  const InitialContactReport& start() const;
  /// The contacts of the held part at X, sorted by part and features: what is in contact (TickReport::contacts) or
  /// carries force; of more than 1024 the nearest. Valid until the next call of step().
  const std::vector<ContactPoint>& contacts() const;
  /// Which of them began and which ended in the last tick, in the same order. Valid until the next call of step().
  const std::vector<ContactEvent>& contact_events() const;
  /// The nearest-feature pairs that limited the last tick's motion, as they are at X (at the pose before the last piece
  /// when the tick was cut). Valid until the next call of step().
  const std::vector<Contact>& constraints() const;
  const Vec3& center() const;                ///< center of mass of the held part, m, file frame
  double radius_of_gyration() const;         ///< of the held part about that center, the mean over three axes, m
  const CouplingSettings& coupling() const;  ///< in use: give these to the servo (ContactLink); see Scene
  const ContactSettings& contact() const;    ///< the settings in use, nothing left open
  const HeldWeight& weight() const;          ///< of the held part, whatever of it is carried now
  double lag_bound() const;                  ///< lag_bound() of the held part, m

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tegotae
