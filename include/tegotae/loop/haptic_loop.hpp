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

/// Events of a tick that its user may want to know.
struct TickFlags {
  /// Time or work ran out before the tick decided on the wanted motion, or the tick ended after its budget.
  bool timed_out = false;
  bool overflow = false;       ///< a capacity was exceeded; the motion is still free
  bool input_ignored = false;  ///< the tick ignored an invalid pen pose or time (see HapticLoop::step)
  bool scene_changed = false;  ///< first tick in a changed scene
  bool part_changed = false;   ///< that scene holds another part; the tick did not follow the pen
};

/// Report of one tick of the contact loop.
struct TickReport {
  std::vector<Pose> substeps;  ///< free poses through which X went, in order; the last one is X (never empty)
  ProxyState proxy;            ///< X, its velocity, and whether it touches
  ContactPlanes planes;        ///< for a servo that updates X between two ticks
  /// Forces of the contacts on the held part at the end of the tick. Together with `forces.lag` they are the wrench of
  /// the coupling's springs, k (X − Y) and k_t rotvec(R_X R_Yᵀ), less `proxy.load`. That is the wrench before the
  /// damper, the servo's newer Y and the safety chain. Only resolvers that project (Resolver::projects, "qp") report
  /// forces, and only while the part touches.
  ContactForces forces;
  int contacts = 0;         ///< feature pairs with a gap of at most contact_gap
  double contact_gap = 0;   ///< largest gap of a contact in this tick, m
  int constraints = 0;      ///< feature pairs that constrained the motion, contacts included
  double gap = 0;           ///< smallest known gap, m; +inf when nothing is within reach; negative where penetrating
  double depth = 0;         ///< depth of the vertex that is deepest inside another part, m; only "penalty" penetrates
  int candidate_parts = 0;  ///< fixed parts that passed the broad phase
  int resolves = 0;         ///< number of programs solved (penalty: Newton steps)
  int iterations = 0;       ///< number of pivots of all programs (impulse: impulses)
  ResolveStatus status = ResolveStatus::not_needed;  ///< of the last program or step of the tick
  double fraction = 1;                               ///< fraction of the wanted motion that the tick made, in [0, 1]
  TickFlags flags;                                   ///< events of the tick
  int filtered = 0;  ///< pairs that overlapped at the start and have not separated yet: nothing keeps them apart
  int shrunk = 0;    ///< pairs that touched at the start and have not separated yet (InitialContact::inward_offset)
  /// How far X lags the pen after the tick, m: the distance of the two centers of mass plus the held part's radius
  /// times the angle between the two poses. While a load pulls at the part, the pen's pose here is the one to which the
  /// load draws the part (loaded()).
  double lag = 0;
  LagReason lag_reason = LagReason::none;  ///< reason for this lag
  /// Number of ticks in which something other than a contact held X back, since the loop began. Such a tick meets three
  /// conditions: the lag is over kMaxUnexplainedLag (scaled, see lag_bound), its reason is neither `none` nor
  /// `contact`, and the part moved no farther than that bound. The tick counts when each of the kLagPatience ticks
  /// before it met them too.
  std::int64_t unexplained_lag_ticks = 0;
};

/// Weight of the held part (WeightSettings).
struct HeldWeight {
  double mass = 0;            ///< kg, as given or from volume and density; 0: the scene has no weight
  double share = 1;           ///< fraction of mass × gravity that the hand carries (WeightSettings::max_force)
  Vec3 force = Vec3::Zero();  ///< N, world: share × mass × gravity
};

/// Largest lag (m) that needs no contact to explain it, for a part with a radius of at least kLagRadius (m) about its
/// center of mass. For a smaller part it is smaller in proportion.
inline constexpr double kMaxUnexplainedLag = 3e-4;
/// Smallest radius (m) of a part for which kMaxUnexplainedLag is not scaled.
inline constexpr double kLagRadius = 0.03;
/// Number of consecutive ticks for which a lag may exceed this bound.
inline constexpr int kLagPatience = 20;
/// Returns the bound (m) for a part of `radius` (m) about its center of mass: 0.3 mm, or 1 % of the radius where that
/// is less.
constexpr double lag_bound(double radius) {
  return kMaxUnexplainedLag * (radius < kLagRadius ? radius / kLagRadius : 1.0);
}

/// The contact loop. It makes the held part follow the pen, and keeps it from intersecting a fixed part, except for the
/// filtered pairs that start() names.
///
/// Threads: make all calls in one thread, except those that any thread may make.
class HapticLoop {
 public:
  /// Builds everything that a tick needs. Where parts only touch, the held part may start a few micrometers beside its
  /// pose in the scene: see start().
  ///
  /// Throws Error when the loop cannot hold the scene. Kind setting: there is not exactly one held part, or a pose or
  /// setting cannot be used. Kind overlap: parts overlap at the start (see ContactSettings::initial_overlap); the
  /// message names the pair, depth and place.
  explicit HapticLoop(const Scene& scene);
  ~HapticLoop();
  HapticLoop(const HapticLoop&) = delete;
  HapticLoop& operator=(const HapticLoop&) = delete;

  /// Runs one tick. `Y` is the pose where the pen wants the held part's file frame, `dt` the time since the last tick
  /// (s). Never throws. The report is valid until the next call.
  ///
  /// A valid pose is finite, of unit length (within 5e-4) and no farther than 10 km from the origin in any coordinate.
  /// Instead of an invalid pose the tick uses the last valid one. A valid time is 0 (then nothing has a velocity) or at
  /// least a microsecond. Instead of an invalid time the tick uses 0. TickFlags::input_ignored reports both.
  const TickReport& step(const Pose& Y, double dt) noexcept;

  /// Sets the share of the weight that the hand carries from the next tick on, from 0 (initially) to 1. Raise it over
  /// some 0.3 s once the force is on: the part sinks by weight / stiffness, and the safety chain turns a force on only
  /// while the wanted force is small.
  void carry(double share) noexcept;

  /// Sets a further load that pulls at the held part from the next tick on, besides its weight, such as that of a
  /// guide. It is a wrench at the part's center of mass (world, N and N·m as the hand feels them). It goes with the
  /// proxy to the servo (ProxyState::load), which gives it to the hand. A wrench that is not finite counts as zero, and
  /// a change of the held part makes it zero. Keep it small and let it grow slowly, as for carry().
  void pull(const Wrench& wrench) noexcept;

  /// Continues in another scene: parts are added, removed, hidden (left out), moved, or another one is held. Any thread
  /// may call it while step() runs. The call builds what is new; parts that share a mesh with the present scene share
  /// its hierarchy. step() switches to the new scene between two ticks, without waiting, allocating or freeing. A later
  /// change replaces one that is still pending. The loop keeps nothing of the old scene's contacts.
  ///
  /// `next` must place the held part at a recent pose of it (TickReport::proxy), where it is free of the other parts.
  /// If the part has moved since, the straight path from there to its present pose must be free of the parts that were
  /// added or moved. Until it is free, the change waits and the old scene stays in force. A part that was not held
  /// before starts at its pose in `next`. The first tick with it does not follow the pen, so that the caller can
  /// re-reference the pen first (ContactLink::home).
  ///
  /// Before step() may switch, the call passes the change's number, and how the held part starts in it, to `ready`, in
  /// the calling thread. Throws Error as the constructor does, and what `ready` throws; then nothing changes.
  SceneChange change(const Scene& next,
                     const std::function<void(std::uint64_t number, const InitialContactReport& start)>& ready = {});
  /// Returns the number of the change in which the last tick ran; 0 before the first change. Any thread may call it.
  std::uint64_t change_in_force() const noexcept;

  /// Returns the name of the part that the scene in force holds. Any thread may call it.
  std::string held() const;

  /// Returns the pose of the held part after the last tick, to draw it and for change(). Any thread may call it.
  Pose latest() const noexcept;

  /// Returns the report of the last step(); before the first one, the report of the start.
  const TickReport& report() const;
  /// Returns the pairs that the held part touched or overlapped at the start, and their state after the last tick.
  const InitialContactReport& start() const;
  /// Returns the contacts of the held part at X, sorted by part and features: pairs that are in contact
  /// (TickReport::contacts) or carry force. Of more than 1024 it returns the nearest ones. Valid until the next call of
  /// step().
  const std::vector<ContactPoint>& contacts() const;
  /// Returns which contacts began and which ended in the last tick, in the same order. Valid until the next call of
  /// step().
  const std::vector<ContactEvent>& contact_events() const;
  /// Returns the nearest-feature pairs that constrained the last tick's motion, as they are at X (when the tick timed
  /// out: at the pose before the last sub-step). Valid until the next call of step().
  const std::vector<Contact>& constraints() const;
  const Vec3& center() const;  ///< center of mass of the held part, m, file frame
  /// Returns the radius of gyration of the held part about that center, the mean over three axes, m.
  double radius_of_gyration() const;
  const CouplingSettings& coupling() const;  ///< settings in use; give these to the servo (ContactLink); see Scene
  const ContactSettings& contact() const;  ///< settings in use, with a value for everything that the scene leaves open
  const HeldWeight& weight() const;        ///< weight of the held part, whatever share of it the hand carries now
  double lag_bound() const;                ///< lag_bound() of the held part, m

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tegotae
