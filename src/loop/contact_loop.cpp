#include "loop/contact_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "loop/contact_margin.hpp"
#include "loop/friction_pairs.hpp"
#include "loop/lag.hpp"
#include "loop/scene_parts.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

std::unique_ptr<Resolver> resolver_of(const ContactSettings& settings) {
  if (!settings.custom_resolver) return make_resolver(settings.resolver, kMaxConstraints);
  auto own = settings.custom_resolver(kMaxConstraints);
  if (!own)
    throw Error(ErrorKind::setting, "contact.custom_resolver made no resolver", {{}, 0, "contact.custom_resolver", {}});
  return own;
}

/// The law of the coupling, by which part and force go together; but the paper's program is in the mass metric.
bool is_in_mass_metric(const ContactSettings& settings) {
  return !settings.custom_resolver && settings.resolver == ResolverKind::lp;
}

Metric metric_of(const Scene& scene, const ContactSettings& settings, const MassProperties& mass) {
  return is_in_mass_metric(settings) ? Metric(mass) : Metric(coupling_radius(scene.coupling, scene.scale));
}

// Triangle pairs that block a trial and become contacts: what is left out shows up in the next trial.
constexpr int kMaxBlocking = 256;
// Sub-steps in one tick; a pen faster than that leaves X behind for a while.
constexpr int kMaxMotions = 16;
// How much faster than the pen X may follow.
constexpr double kCatchUp = 2.0;
// A sub-step of at least this share of its longest was cut short by that, not by contacts.
constexpr double kFullShare = 0.99;
// After a timeout the next sub-step tries this many times the length that was proved.
constexpr double kProvedGrowth = 2;
// Programs solved for one sub-step before it is shortened instead.
constexpr int kMaxResolves = 6;
// Sub-steps that planes for one motion hold (see kShorter) in one tick.
constexpr int kMaxShorter = 3;
// Halvings of a sub-step that still intersects.
constexpr int kMaxHalvings = 4;
// Forces of a sub-step that are remembered until the end of the tick.
constexpr std::size_t kMaxForces = 64;
// The margin in the closest fits (m): under half of 5 µm radial clearance, over kGapFloor.
constexpr double kMinMargin = 2e-6;
// Trust region: a sub-step that brought less than the first share of the promised decrease of the squared error halves
// it, more than the second doubles it; it never falls below this many times the pen's motion of the tick. It never
// falls below this length (m), or a part whose way was blocked would not try again.
constexpr double kMinTrust = 1e-8;
constexpr double kPoor = 0.25, kGood = 0.7, kPenShare = 1.5;
// In the mass metric a rotation error larger than this (rad) is taken in parts: the metric of a rotation vector has its
// slope towards the target only while the angle is small. That of the coupling weighs all axes the same, and has it
// always.
constexpr double kMaxTurn = 0.5;
// While the pen stands still and X has arrived, a sub-step must take this share off the squared error for every tick
// since then, up to so many: like static friction, it ends the creep that is left where constraints change with every
// sub-step. While X still comes, as fast as it may, it does not creep: it would be stopped short of its place after a
// long way.
constexpr double kStiction = 1e-6;
constexpr int kMaxStillTicks = 250;
// The same, after those ticks, for every one in which the part swings, as often as that takes: gaps that steps lose on
// surfaces that curve, and steps that open them again, would go on for ever where each is larger than creep is.
constexpr double kSwingStiction = 1e-4;
// Of what the springs pull, the share of a lag that is more than the last hair of a part at rest (see kStiction).
constexpr double kFeltLag = 0.05;
// Contacts explain a lag where steps that open gaps take back this share of what the others bring.
constexpr double kTakenBack = 0.5;
// Until so much of the tick's budget is over, what is left of a tick prepares for the next ones.
constexpr double kPrepareShare = 0.9;
// A motion of less than this share of the margin is nearly none: where it was out of time in so many ticks in a row, it
// is not asked about again until the pen has moved by a margin.
constexpr double kHair = 0.05;
constexpr int kLateHairs = 30;
// Contacts that all open by this share of the way to the pen, and more, are left.
constexpr double kOpens = 0.05;
// What is no farther than this share of the part's radius holds a part that is out of time.
constexpr double kNearShare = 1.5e-3;
// Parts that are nearer than this (m) touch, or hardly come nearer.
constexpr double kNearGap = 100e-6;

bool same(const Displacement& a, const Displacement& b) {
  return a.dp == b.dp && a.dr == b.dr;
}

/// By how much `d` opens a contact (m).
double opening(const Contact& c, const Displacement& d) {
  return c.n.dot(d.dp + d.dr.cross(c.r));
}

}  // namespace

ContactLoop::ContactLoop(const Scene& scene, const ContactSettings& settings, const MassProperties& mass)
    : settings_(settings),
      center_(mass.center),
      at_(scene, settings, mass),
      metric_(metric_of(scene, settings, mass)),
      max_turn_(is_in_mass_metric(settings) ? kMaxTurn : std::numeric_limits<double>::infinity()),
      resolver_(resolver_of(settings)),
      rows_(kMaxConstraints),
      bounds_(kMaxConstraints),
      friction_(resolver_->knows_friction() ? friction_of_parts(scene) : std::vector<double>(), kMaxConstraints),
      planes_(kMaxConstraints, scene.coupling, scene.scale),
      trail_(center_, at_.radius) {
  trust_ = substep_cap_ = at_.check->longest_motion();
  max_margin_ = margin_ = kMarginShare * *settings_.l_min;
  min_margin_ = scene.contact.l_min ? max_margin_ : std::min(kMinMargin, max_margin_);
  near_gap_ = std::max(*settings_.l_min, kNearShare * at_.radius);
  recover_below_ = kRecoverBelow;
  X_ = at_.X;
  last_Y_ = held_part(scene).pose;
  blocking_.reserve(kMaxBlocking);
  touched_faces_.reserve(Trail::kFaces);
  near_.reserve(at_.spheres.size());
  known_.reserve(kMaxForces);
  guess_.reserve(kMaxForces);
}

bool ContactLoop::take_over(const TickReport& last, const Pose& Y, const std::vector<bool>* fresh,
                            std::int64_t deadline_ns) {
  if (!at_.is_path_free(X_, last.proxy.X, center_, fresh, deadline_ns, near_, blocking_)) return false;
  trail_.forget();
  X_ = last.proxy.X;
  at_.check->jumped();
  last_Y_ = Y;
  tracked_ = touched_ = false;
  owed_.reset();
  shortcut_.reset();
  late_hairs_ = 0;
  swings_.forget();
  margin_ = std::clamp(kMarginShare * last.contact_gap, min_margin_, max_margin_);
  return true;
}

void ContactLoop::stand_at(const Pose& X) {
  X_ = last_Y_ = X;
  trail_.forget();
  at_.check->jumped();
  at_.contacts->clear();
  near_.clear();
  // Nothing is near: what the check knew of parts that were goes.
  at_.check->begin(near_, kNoDeadline, OtherParts::far);
  tracked_ = timed_out_ = comes_ = touched_ = queried_ = false;
  owed_.reset();
  shortcut_.reset();
  late_hairs_ = 0;
  margin_ = max_margin_;
  trust_ = substep_cap_;
  moved_ = 0;
  still_ticks_ = 0;
}

void ContactLoop::step(const Pose& Y, double dt, std::int64_t deadline_ns, TickReport& report) {
  const Pose X_before = X_;
  deadline_ns_ = deadline_ns;
  const double wanted = size(displacement(X_, Y, center_));
  const Displacement pen_moved = displacement(last_Y_, Y, center_);
  const double pen = size(pen_moved);
  last_Y_ = Y;
  still_ticks_ = pen < kRest && !comes_ ? std::min(still_ticks_ + 1, kMaxStillTicks) : 0;
  if (still_ticks_ < kMaxStillTicks) swings_.forget();
  // The pen's motion is followed within the tick, an older lag at twice its pace over the next ticks.
  const double travel = std::max(substep_cap_, kCatchUp * pen);
  if (at_.poll_initial_contacts(X_)) {
    tracked_ = false;
    trail_.forget();
    shortcut_.reset();
  }
  at_.query(X_, center_, std::min(wanted, travel) + at_.reach, near_);
  report.candidate_parts = static_cast<int>(near_.size());
  held_by_contacts_ = false;
  known_.clear();
  allowed_ = wanted;
  made_ = gained_ = lost_ = 0;
  if (near_.empty())
    move_in_air(Y, wanted, travel, report);
  else
    move_near_parts(Y, travel, pen_moved, report);
  at_.fill_report(margin_ / kMarginShare, report);
  // Where the kept gap has shrunk, contacts may hold the part a little above it.
  if (report.contacts == 0 && wanted > margin_ && report.gap <= *settings_.l_min)
    at_.fill_report(*settings_.l_min, report);
  const Displacement moved = displacement(X_before, X_, center_);
  moved_ = size(moved);
  count_swings(Y);
  const double left = size(displacement(X_, Y, center_));
  // Out of time a little above what it comes to, the part is where it should be, but for less than needs to be
  // explained.
  const double bound = lag_bound(at_.radius);
  if (report.contacts == 0 && left > std::min(bound, near_gap_) && moved_ <= bound)
    if (const double gap = gap_in_the_way(Y); gap <= near_gap_) at_.fill_report(gap, report);
  if (report.contacts > 0 && tracked_ && trail_.is_at(X_)) {
    at_.contacts->faces_within(report.contact_gap, Trail::kFaces, touched_faces_);
    trail_.touches(touched_faces_);
  }
  report.lag_reason = reason_for(left, report);
  // The hand feels whatever holds the part back. Nothing does where the part moves as fast as it may: after a change
  // that removed what it touched, it comes back to the pen through the air.
  comes_ = near_.empty() || made_ >= kFullShare * travel;
  // On its way from a contact that it slipped off to the next one, a surface is still beside it: there the springs'
  // force stays, or it would drop out for these few ticks and come back.
  const bool slips = comes_ && touched_ && !near_.empty() && report.gap <= substep_cap_;
  report.proxy.touching =
      report.contacts > 0 || (report.lag_reason != LagReason::none && (!comes_ || slips) && left > margin_);
  touched_ = report.proxy.touching;
  report.fraction = wanted > kRest ? std::clamp(1 - left / wanted, 0.0, 1.0) : 1;
  report.proxy.X = X_;
  // The pace of a slip is the loop's, not the hand's: the damper does not answer it.
  report.proxy.velocity = dt > 0 && !slips ? Twist{moved.dp / dt, moved.dr / dt} : Twist{};
  report.flags.timed_out |= late();
  timed_out_ = report.flags.timed_out;
  report_forces(Y, report);
  report_slip(moved, report.forces);
  // The time that the tick leaves over prepares for the first touch.
  if (!near_.empty() && deadline_ns_ != kNoDeadline && report.gap > kNearGap) {
    const Displacement to_pen = displacement(X_, Y, center_);
    at_.check->prepare(X_, {to_pen.dp + pen_moved.dp, to_pen.dr + pen_moved.dr},
                       deadline_ns_ - static_cast<std::int64_t>(1e9 * (1 - kPrepareShare) * settings_.tick_budget));
  }
}

void ContactLoop::move_in_air(const Pose& Y, double wanted, double travel, TickReport& report) {
  const Pose from = X_;
  X_ = displaced(X_, center_, std::min(1.0, travel / wanted) * displacement(X_, Y, center_));
  if (wanted <= travel) X_ = Y;
  trail_.went(from, X_);
  report.substeps.push_back(X_);
  at_.contacts->clear();
  tracked_ = false;
  owed_.reset();
  shortcut_.reset();
}

void ContactLoop::move_near_parts(const Pose& Y, double travel, const Displacement& pen, TickReport& report) {
  at_.check->begin(near_, deadline_ns_, OtherParts::far);
  at_.check->trust_start();
  if (track()) adapt_margin(Y);
  Heading heading{pen, touches() && !leaves(Y), margin_ / kMarginShare, near_gap_, shortcut_.has_value()};
  at_.check->heads(heading);
  if (heading.whole && !waits_for_shortcut(Y, report)) {
    heading.whole = false;
    at_.check->heads(heading);
  }
  const bool waits = heading.whole;
  trust_ = std::max(trust_, kMinTrust);
  if (!timed_out_) trust_ = std::max(trust_, std::min(substep_cap_, kPenShare * size(pen)));
  if (at_.check->prefers_long()) trust_ = substep_cap_;
  int shorter = 0;
  for (int i = 0; i < kMaxMotions && made_ < travel && !late() && !waits; ++i) {
    const double cap = std::min({trust_, substep_cap_, travel - made_});
    const double length = move_substep(Y, cap, report);
    if (length > 0) report.substeps.push_back(X_);
    // A sub-step shorter than it could be is the resolver's own end, but where planes of a longer motion made it
    // short.
    if (length < kFullShare * cap && !(held_by_planes_ && ++shorter <= kMaxShorter)) break;
    made_ += length;
  }
  stuck_ = late() ? stuck_ + 1 : 0;
  if (made_ == 0 && late() && !touches() && !waits) follow_trail(Y, pen, travel, report);
  if (report.substeps.empty()) report.substeps.push_back(X_);
  if (!late()) track();
}

void ContactLoop::report_forces(const Pose& Y, TickReport& report) {
  report.planes.count = 0;
  report.forces = {};
  // Where X is not what the coupling's law gives, the wrench is not the contacts', and planes would make it another X.
  if (!resolver_->projects()) return;
  if (tracked_) {
    metric_.set_orientation(X_.q);
    planes_.pick(at_.contacts->constraints(), metric_, friction_, X_, Y, center_, margin_, known_forces(), deadline_ns_,
                 report.planes, report.forces);
  } else {
    // Out of time, the constraints may be those of an earlier pose.
    report.forces.lag = planes_.pull(displacement(X_, Y, center_));
  }
  // What holds the part back is not a contact, and the hand is to feel it: the servo must not follow the pen meanwhile.
  const bool held_up = report.lag_reason == LagReason::time || report.lag_reason == LagReason::capacity;
  const Wrench whole = planes_.pull(displacement(X_, Y, center_));
  const Wrench& lag = report.forces.lag;
  if (held_up &&
      (lag.force.norm() > kFeltLag * whole.force.norm() || lag.torque.norm() > kFeltLag * whole.torque.norm()))
    report.planes.count = 0;
  if (!report.proxy.touching) report.forces = {};
}

bool ContactLoop::late() const {
  return past(deadline_ns_);
}

bool ContactLoop::track() {
  if (!tracked_) tracked_ = at_.contacts->track(X_, at_.reach, deadline_ns_);
  return tracked_;
}

double ContactLoop::move_substep(const Pose& Y, double cap, TickReport& report) {
  held_by_planes_ = false;
  if (!track()) return 0;
  const std::optional<Displacement> taken_in = std::exchange(owed_, std::nullopt);
  if (taken_in) take_in(*taken_in);
  metric_.set_orientation(X_.q);
  Displacement error = displacement(X_, Y, center_);
  const double turn = error.dr.norm();
  if (turn > max_turn_) error.dr *= max_turn_ / turn;
  const Pose goal = turn > max_turn_ ? displaced(X_, center_, error) : Y;
  const Vec6 wanted = metric_.whiten(error);
  Trial trial;
  bool free = false;
  for (int i = 0; i < kMaxResolves; ++i) {
    if (late() || !resolve(wanted, cap, report, trial)) return 0;
    if (size(trial.d) < kRest) {
      if (i + 1 < kMaxResolves && query_around()) continue;
      held_by_contacts_ = only_contacts();
      if (!resolver_->projects()) trust_ *= 0.5;
      if (has_cutting_planes()) shorter_than(cap);
      return 0;
    }
    const bool hair = size(trial.d) < kHair * margin_;
    if (hair && gives_up_on_hairs(Y)) {
      held_by_contacts_ = only_contacts();
      return 0;
    }
    free = is_free(trial, report);
    if (!hair || !late()) late_hairs_ = 0;
    if (hair && late() && ++late_hairs_ == 1) hairs_Y_ = Y;
    if (const auto other = at_.check->instead()) {
      trial.d = *other;
      Trial part = trial;
      scale(part, at_.check->free_share());
      // Contacts turn a long motion into its obstacles where they curve.
      if (!blocking_.empty()) trust_ = std::max({kProvedGrowth * size(part.d), kShorter * trust_, kMinTrust});
      if (free) {
        trial = part;
        break;
      }
      if (size(part.d) > kRest) {
        if (!leads_nearer(part, goal)) return 0;
        if (!blocking_.empty()) owed_ = *other;
        go_to(part);
        return size(part.d);
      }
      if (blocking_.empty()) return 0;
    } else if (free) {
      break;
    }
    // What was in the way of the same motion once and is so again does not turn it.
    const bool again = taken_in && same(*taken_in, trial.d);
    if (late() && !blocking_.empty() && !again) owed_ = trial.d;
    if ((blocking_.empty() || late()) && at_.check->free_share() > 0) {
      // Out of time or work: what is proved of the motion is made, and the next sub-step is not much longer, or as long
      // as all that was proved in this tick.
      scale(trial, at_.check->free_share());
      trust_ = std::max({kProvedGrowth * size(trial.d), made_ + size(trial.d), kMinTrust});
      go_to(trial);
      return size(trial.d);
    }
    if (late()) {
      // What was begun in what other sub-steps left of the tick may need no more than a whole one: to go on with half
      // of it in every tick would be to creep for good.
      if (made_ == 0) trust_ = 0.5 * std::min(trust_, size(trial.d));
      return 0;
    }
    if (!take_in(trial.d)) break;
  }
  if (!free) {
    trust_ = 0.5 * std::min(trust_, size(trial.d));
    if (!shorten(trial, report)) return 0;
  }
  const bool worth = worth_it(wanted, trial, goal);
  if (has_cutting_planes() && (!worth || size(trial.d) < kWorthwhile * cap)) shorter_than(cap);
  if (!worth) {
    held_by_contacts_ = only_contacts();
    query_around();
    return 0;
  }
  go_to(trial);
  queried_ = false;
  return size(trial.d);
}

/// At rest on a large seat, a motion of nearly nothing would take every tick whole.
bool ContactLoop::gives_up_on_hairs(const Pose& Y) {
  if (size(displacement(hairs_Y_, Y, center_)) > margin_) late_hairs_ = 0;
  return late_hairs_ >= kLateHairs;
}

void ContactLoop::go_to(const Trial& trial) {
  trail_.went(X_, trial.X);
  X_ = trial.X;
  tracked_ = false;
  allowed_ = std::max(0.0, allowed_ - size(trial.d));
}

bool ContactLoop::take_in(const Displacement& d) {
  return at_.contacts->seed(blocking_, at_.check->near_contact(X_, d, blocking_), deadline_ns_) > 0 ||
         at_.contacts->add_cutting_planes(blocking_, d, kGapFloor, deadline_ns_) > 0;
}

bool ContactLoop::query_around() {
  // Sub-steps need leave the certificate's clearance only, so that a part may have come to rest nearer to a surface
  // that was in no sub-step's way than to the contacts that hold it.
  if (queried_ || moved_ > kStanding || has_cutting_planes()) return false;
  queried_ = true;
  blocking_.clear();
  at_.check->check(X_, {}, kRecoverBelow * margin_, blocking_);
  return at_.contacts->seed(blocking_, X_, deadline_ns_) > 0;
}

void ContactLoop::shorter_than(double cap) {
  trust_ = kShorter * std::min(trust_, cap);
  held_by_planes_ = true;
  tracked_ = false;  // tracking forgets the planes
}

bool ContactLoop::has_cutting_planes() const {
  const auto& constraints = at_.contacts->constraints();
  return std::any_of(constraints.begin(), constraints.end(), [](const Contact& c) { return c.age == kOneShotAge; });
}

void ContactLoop::count_swings(const Pose& Y) {
  const Displacement left = displacement(X_, Y, center_);
  // A larger turn is taken in parts, of which none need bring the whole nearer.
  if (still_ticks_ < kMaxStillTicks || left.dr.norm() > max_turn_) return;
  metric_.set_orientation(X_.q);
  swings_.add(metric_.whiten(left).squaredNorm(), kStiction, moved_ > kRest);
}

LagReason ContactLoop::reason_for(double lag, const TickReport& report) const {
  TickEnd end;
  end.lag = lag;
  end.bound = lag_bound(at_.radius);
  end.contacts = report.contacts;
  end.held_by_contacts = held_by_contacts_;
  // What the contacts allow and take back again is not a way to the pen.
  end.allowed = lost_ > kTakenBack * gained_ ? 0 : allowed_;
  end.late = late();
  end.moved = moved_ > kRest;
  return lag_reason(end);
}

bool ContactLoop::is_free(const Trial& trial, TickReport& report) {
  blocking_.clear();
  const MotionAnswer answer = at_.check->check(X_, trial.d, kGapFloor, blocking_);
  report.flags.timed_out |= answer == MotionAnswer::unknown;
  return answer == MotionAnswer::free;
}

bool ContactLoop::touches() const {
  const auto& constraints = at_.contacts->constraints();
  return std::any_of(constraints.begin(), constraints.end(),
                     [this](const Contact& c) { return c.age != kOneShotAge && c.gap <= margin_ / kMarginShare; });
}

double ContactLoop::gap_in_the_way(const Pose& Y) const {
  const Displacement d = displacement(X_, Y, center_);
  double nearest = std::numeric_limits<double>::infinity();
  for (const Contact& c : at_.contacts->constraints())
    if (c.age != kOneShotAge && -opening(c, d) > c.gap) nearest = std::min(nearest, c.gap);
  return nearest;
}

bool ContactLoop::leaves(const Pose& Y) const {
  const auto& constraints = at_.contacts->constraints();
  const Displacement d = displacement(X_, Y, center_);
  const double least = kOpens * size(d);
  return std::all_of(constraints.begin(), constraints.end(), [&](const Contact& c) {
    return c.age == kOneShotAge || c.gap > margin_ / kMarginShare || opening(c, d) > least;
  });
}

/// What was asked for in another tick may lead away by now.
bool ContactLoop::leads_nearer(const Trial& trial, const Pose& goal) const {
  return metric_.whiten(displacement(trial.X, goal, center_)).squaredNorm() <
         metric_.whiten(displacement(X_, goal, center_)).squaredNorm();
}

void ContactLoop::scale(Trial& trial, double share) const {
  trial.d = share * trial.d;
  trial.X = displaced(X_, center_, trial.d);
}

bool ContactLoop::shorten(Trial& trial, TickReport& report) {
  const double share = at_.check->free_share();
  if (share > kWorthwhile) {
    scale(trial, share);
    return true;
  }
  for (int i = 0; i < kMaxHalvings && !late(); ++i) {
    scale(trial, 0.5);
    if (is_free(trial, report)) return true;
  }
  return false;
}

bool ContactLoop::worth_it(const Vec6& error, const Trial& trial, const Pose& Y) {
  // The program sees flat constraints. Where they curve, the error that it promises to take away does not all go, or
  // even grows: near the end of the way such steps would swing to and fro for ever.
  const Vec6 step = metric_.whiten(trial.d);
  const double promised = error.squaredNorm() - (error - step).squaredNorm();
  const double made = error.squaredNorm() - metric_.whiten(displacement(trial.X, Y, center_)).squaredNorm();
  (made > 0 ? gained_ : lost_) += std::abs(made);
  if (promised <= 0) return true;  // a step that only opens gaps
  if (made < kPoor * promised) trust_ = 0.5 * std::min(trust_, size(trial.d));
  if (made > kGood * promised) trust_ = std::min(2 * trust_, substep_cap_);
  return made > (kStiction * still_ticks_ + kSwingStiction * swings_.ticks()) * error.squaredNorm();
}

}  // namespace tegotae
