#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "loop/collision_world.hpp"
#include "loop/contact_planes.hpp"
#include "loop/proxy_loop.hpp"
#include "loop/swings.hpp"
#include "loop/trail.hpp"
#include "resolve/friction_rows.hpp"
#include "resolve/metric.hpp"
#include "tegotae/resolve/resolver.hpp"

namespace tegotae {

/// The loop of the resolvers that solve a program, lp and qp (one tick: broad phase, tracking, contacts, resolver,
/// free check), over a scene in which parts may touch at the start.
class ContactLoop final : public ProxyLoop {
 public:
  ContactLoop(const Scene& scene, const ContactSettings& settings, const MassProperties& mass);

  void step(const Pose& Y, double dt, std::int64_t deadline_ns, TickReport& report) override;
  bool take_over(const TickReport& last, const Pose& Y, const std::vector<bool>* fresh,
                 std::int64_t deadline_ns) override;
  /// Puts the part at `X`, which is known to be free, as if pen and part had stood there: of contacts and motions
  /// before, nothing is kept.
  void stand_at(const Pose& X);
  const Pose& pose() const override { return X_; }
  /// The constraints at the end of the last tick.
  const std::vector<Contact>& constraints() const override { return at_.contacts->constraints(); }
  const InitialContactReport& start() const override { return at_.start.report(); }

 private:
  /// A motion that moves no point farther than this (m) counts as rest.
  static constexpr double kRest = 1e-10;
  /// A part that moved less than this in a tick (m) stands.
  static constexpr double kStanding = 2e-6;
  /// A blocked sub-step is made as far as it is free, from this share on; below it, shorter ones are tried.
  static constexpr double kWorthwhile = 0.25;
  /// One-shot planes that leave little of a motion hold the part where no surface does: the tick tries a sub-step of
  /// this share of its length without them.
  static constexpr double kShorter = 0.25;

  /// A displacement together with the pose it leads to.
  struct Trial {
    Displacement d;
    Pose X;
  };

  /// Moves X towards Y by one free sub-step no longer than `cap`; returns its length (m), 0 at rest or when blocked.
  double move_substep(const Pose& Y, double cap, TickReport& report);
  /// The trial of at most `cap` that the constraints allow; false when there is none.
  bool resolve(const Vec6& wanted, double cap, TickReport& report, Trial& trial);
  /// One program over the constraints: an allowed `motion` for `wanted`.
  bool solve(const Vec6& wanted, TickReport& report, Vec6& motion);
  /// Whether `motion` leads farther away from the pen, which is `wanted` away, than recovering gaps is worth.
  bool is_long_way_back(const Vec6& motion, const Vec6& wanted) const;
  /// A program that does not project may bring the part nearer to the pen when it is asked for a shorter motion than
  /// the whole. Tries some, and leaves the best answer in `motion`. Returns false when none of them has an answer.
  bool try_shorter_motions(const Vec6& wanted, double cap, TickReport& report, Vec6& motion);
  /// The last forces of a sub-step, as forces of the contacts that are tracked now.
  const std::vector<FrictionForce>& known_forces();
  /// The same with friction, without gaps that should open.
  bool solve_with_friction(const Vec6& wanted, TickReport& report, Vec6& motion);
  /// Opens gaps that were lost, by the least change of `motion`, where that is possible and short.
  void recover_gaps(TickReport& report, Vec6& motion);
  /// Sets which of the contacts that carry have slid in the tick, in which X moved by `moved`.
  void report_slip(const Displacement& moved, ContactForces& forces) const;
  /// Lets the narrow phase check the trial; blocking_ then holds what blocks it.
  bool is_free(const Trial& trial, TickReport& report);
  /// Makes contacts or cutting planes of what blocks `d`. Returns whether there are new ones.
  bool take_in(const Displacement& d);
  bool shorten(Trial& trial, TickReport& report);
  void go_to(const Trial& trial);
  /// Whether motions of nearly nothing are left alone, since they were out of time for long with the pen here.
  bool gives_up_on_hairs(const Pose& Y);
  /// Whether a contact is within reach.
  bool touches() const;
  /// The gap (m) of the nearest contact that the part would enter on its way to the pen; +inf where there is none.
  double gap_in_the_way(const Pose& Y) const;
  /// Whether all that touches opens on the way to the pen.
  bool leaves(const Pose& Y) const;
  bool leads_nearer(const Trial& trial, const Pose& goal) const;
  /// Shortens the trial to `share` of it.
  void scale(Trial& trial, double share) const;
  /// Whether the trial brings X nearer to Y; adapts the trust region.
  bool worth_it(const Vec6& error, const Trial& trial, const Pose& Y);
  bool late() const;
  /// The motion of a tick in which nothing is near: at most `travel` (m) of the `wanted` (m) to Y.
  void move_in_air(const Pose& Y, double wanted, double travel, TickReport& report);
  /// The sub-steps of a tick among near parts, at most `travel` (m), under a pen that moved by `pen` (m).
  void move_near_parts(const Pose& Y, double travel, const Displacement& pen, TickReport& report);
  /// Where no way to the pen was proved in time: along the trail, at most `travel` (m) from where the part is, if that
  /// leads much nearer.
  void follow_trail(const Pose& Y, const Displacement& pen, double travel, TickReport& report);
  /// Whether the pen moves to where the part touched something.
  bool comes_back_by(const Displacement& pen) const;
  /// A place between two poses of the trail: a share of the way to that number.
  struct OnTrail {
    Trail::Side side = Trail::Side::back;
    std::size_t pose = 0;
    double share = 0;
    bool across = false;  ///< the trail leads there by too long a way
    double left = 0;      ///< squared, from there to the pen; 0 where it touched something and nothing leads away first
  };
  Pose pose_of(const OnTrail& place) const;
  /// How near (m) the nearest feature is that is known.
  double least_gap() const;
  /// Goes to the place that is short across the trail, if that way is proved. Whether a look at it goes on.
  bool waits_for_shortcut(const Pose& Y, TickReport& report);
  /// Where a side of it comes nearer to the pen than `nearest`, and where it touched something than `touched`; if it
  /// leads away from the pen first, by no more than `travel` (m) of it, or no farther `across` (m).
  void find_on_trail(Trail::Side side, const Pose& Y, double travel, double across, OnTrail& nearest,
                     OnTrail& touched) const;
  /// Fills in the contact planes and forces of the report.
  void report_forces(const Pose& Y, TickReport& report);
  /// Adapts the margin of contacts to the clearance of the fit.
  void adapt_margin(const Pose& Y);
  /// Whether contacts press from opposite sides.
  bool wedged() const;
  /// Tracks the contacts to X_; false when time ran out first (the next tick continues).
  bool track();
  /// Once for each pose at which X rests: makes contacts of all that is nearer than the margin. Returns whether there
  /// are new ones.
  bool query_around();
  /// Makes the next sub-step shorter than this one, which cutting planes limit, and drops these planes.
  void shorter_than(double cap);
  /// Whether a cutting plane limits the motion.
  bool has_cutting_planes() const;
  /// Marks the constraints that `motion` uses up: they carry.
  void mark_carriers(const Vec6& motion);
  /// Constraint number `i` carries in the last program.
  void carries(std::size_t i);
  /// Whether no cutting plane carries in the last program but those between triangles that touch: they are contacts,
  /// whatever features they come from.
  bool only_contacts() const { return !has_cutting_planes() || !far_planes_; }
  /// At the end of a tick, in which X moved by moved_.
  void count_swings(const Pose& Y);
  LagReason reason_for(double lag, const TickReport& report) const;
  /// Bound on how far `d` carries any point of the held part (m).
  double size(const Displacement& d) const { return d.dp.norm() + at_.radius * d.dr.norm(); }

  ContactSettings settings_;
  Vec3 center_;
  CollisionWorld at_;
  double substep_cap_;  ///< longest sub-step near other parts, m
  Metric metric_;
  double max_turn_;  ///< of a rotation error, rad
  std::unique_ptr<Resolver> resolver_;
  LowRankMatrix rows_;
  std::vector<double> bounds_;
  FrictionRows friction_;
  /// A force of the last sub-step with friction and the features that it was between.
  struct KnownForce {
    PartId part;
    Feature feature_a, feature_b;
    FrictionForce force;
  };
  std::vector<KnownForce> known_;
  std::vector<FrictionForce> guess_;
  PlanePicker planes_;
  std::vector<std::uint32_t> near_;
  std::vector<FacePair> blocking_;
  Trail trail_;
  /// To a place on the trail that is near, and only far along it.
  struct Shortcut {
    OnTrail to;
    int ticks = 0;  ///< in which it was asked about
  };
  std::optional<Shortcut> shortcut_;
  Pose in_vain_;                         ///< where the last one was not proved
  int stuck_ = 0;                        ///< ticks in a row that were out of time
  int waited_ = 0;                       ///< those of them that waited for the rest of a look
  std::vector<FacePair> touched_faces_;  ///< of the trail; blocking_ is of the motion that is owed
  Pose X_;
  Pose last_Y_;
  double trust_;
  double moved_ = 0;     ///< of X in the last tick, m
  double made_ = 0;      ///< sub-steps of this tick, m
  double gained_ = 0;    ///< of the squared error, by sub-steps of this tick
  double lost_ = 0;      ///< the same, by those that led away
  int still_ticks_ = 0;  ///< since the pen last moved or X was on its way to it
  Swings swings_;        ///< under a pen that has stood still for long
  double margin_;        ///< gap that contacts keep, m, between the next two
  double min_margin_, max_margin_;
  double near_gap_;       ///< a contact that is in the way and no farther (m) explains a lag
  double recover_below_;  ///< share of the kept gap below which gaps recover
  int ticks_ = 0;
  int late_hairs_ = 0;  ///< ticks in a row that were out of time for motions of nearly nothing
  Pose hairs_Y_;        ///< the pen's pose at the first of them
  std::optional<Displacement>
      owed_;                     ///< motion of the last tick that blocking_ stopped when no time was left for contacts
  bool tracked_ = false;         ///< the contacts are those of X_
  bool timed_out_ = false;       ///< the last tick
  bool comes_ = false;           ///< X went as fast as it may in the last tick
  bool touched_ = false;         ///< ProxyState::touching after the last tick
  bool queried_ = false;         ///< query_around() did at this pose
  bool far_planes_ = false;      ///< see only_contacts()
  bool held_by_planes_ = false;  ///< planes for one motion made the last sub-step short
  bool held_by_contacts_ = false;  ///< see TickEnd
  double allowed_ = 0;             ///< see TickEnd, m
  std::int64_t deadline_ns_ = 0;
};

}  // namespace tegotae
