#include "loop/contact_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "loop/friction_pairs.hpp"
#include "loop/kept_gap.hpp"
#include "loop/lag.hpp"
#include "loop/scene_parts.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

std::unique_ptr<Resolver> resolver_of(const ContactSettings& settings) {
  if (!settings.custom_resolver) return make_resolver(settings.resolver, kMaxLimits);
  auto own = settings.custom_resolver(kMaxLimits);
  if (!own) throw Error("contact.custom_resolver made no resolver");
  return own;
}

/// The law of the coupling, by which part and force go together; but the paper's program is in the mass metric.
bool is_in_mass_metric(const ContactSettings& settings) {
  return !settings.custom_resolver && settings.resolver == ResolverKind::lp;
}

Metric metric_of(const Scene& scene, const ContactSettings& settings, const MassProperties& mass) {
  return is_in_mass_metric(settings) ? Metric(mass) : Metric(coupling_radius(scene.coupling, scene.scale));
}

// Triangle pairs in the way of a trial that are looked at: what they miss shows at the next trial.
constexpr int kMaxBlocking = 256;
// Pieces in one tick; a pen faster than that leaves X behind for a while.
constexpr int kMaxMotions = 16;
// How much faster than the pen X may follow.
constexpr double kCatchUp = 2.0;
// A piece of at least this share of its longest was cut short by that, not by contacts.
constexpr double kFullShare = 0.99;
// What of a piece was proved in the time there was is tried so many times as long next.
constexpr double kProvedGrowth = 2;
// Programs solved for one piece before it is shortened instead.
constexpr int kMaxResolves = 6;
// Planes for one motion alone that leave little of it hold the part, and no surface does: a piece of this share of its
// length is tried without them, so often in one tick.
constexpr double kShorter = 0.25;
constexpr int kMaxShorter = 3;
// Halvings of a piece that still intersects.
constexpr int kMaxHalvings = 4;
// Share of a blocked piece that is made as it is; for less, shorter pieces are tried.
constexpr double kWorthwhile = 0.25;
// Contacts are kept at this share of l_min, so that rounding and curvature do not make a resting contact come and go.
constexpr double kKeepShare = 0.5;
// Between the gap kept in the closest fits and l_min the room is looked at every so many ticks; the gap grows by this
// factor where there is room for more.
constexpr int kAdaptTicks = 8;
constexpr double kKeepGrowth = 1.1;
// A part that moved less than this in a tick (m) stands; normals with less than this dot product are of opposite sides,
// looked for among about so many limits.
constexpr double kStanding = 2e-6, kOpposite = -0.3;
constexpr std::size_t kMaxWedging = 64;
// A part that stands between opposite sides and may go along them by this share of its way, if the limits give way by
// the noise of their normals, is held by that noise alone: walls that meet at 1e-7 rad are parallel.
constexpr double kAlongShare = 1e-2;
// Forces of a piece that are remembered until the end of the tick.
constexpr std::size_t kMaxForces = 64;
// Kept in the closest fits (m): under half of 5 µm radial clearance, over the gap floor below.
constexpr double kMinKeep = 2e-6;
// A motion that carries no point farther than this (m) is rest.
constexpr double kRest = 1e-10;
// Trust region: a piece that brought less than the first share of the promised decrease of the squared error halves it,
// more than the second doubles it; it never falls below this many times the pen's motion of the tick.
// It never falls below this length (m), or a part whose way was blocked would not try again.
constexpr double kMinTrust = 1e-8;
// In the mass metric a rotation error larger than this (rad) is taken in parts: the metric of a rotation vector has its
// slope towards the target only while the angle is small. That of the coupling weighs all axes the same, and has it
// always.
constexpr double kMaxTurn = 0.5;
// While the pen stands still and X has arrived, a piece must take this share off the squared error for every tick since
// then, up to so many: like static friction, it ends the creep that is left where limits change with every piece. While
// X still comes, as fast as it may, it does not creep: it would be stopped short of its place after a long way.
constexpr double kStiction = 1e-6;
constexpr int kMaxStillTicks = 250;
// Of what the springs pull, the share of a lag that is more than the last hair of a part at rest (see kStiction).
constexpr double kFeltLag = 0.05;
// Until so much of the tick's budget is over, what is left of a tick prepares for the next ones.
constexpr double kPrepareShare = 0.7;
// Parts that are nearer than this (m) touch, or hardly come nearer.
constexpr double kNearGap = 100e-6;
constexpr double kPoor = 0.25, kGood = 0.7, kPenShare = 1.5;

}  // namespace

ContactLoop::ContactLoop(const Scene& scene, const ContactSettings& settings, const MassProperties& mass)
    : settings_(settings),
      center_(mass.center),
      at_(scene, settings, mass),
      metric_(metric_of(scene, settings, mass)),
      most_turn_(is_in_mass_metric(settings) ? kMaxTurn : std::numeric_limits<double>::infinity()),
      resolver_(resolver_of(settings)),
      rows_(kMaxLimits),
      bounds_(kMaxLimits),
      friction_(resolver_->knows_friction() ? friction_of_parts(scene) : std::vector<double>(), kMaxLimits),
      planes_(kMaxLimits, scene.coupling, scene.scale) {
  trust_ = piece_cap_ = at_.check->longest_motion();
  most_keep_ = keep_ = kKeepShare * *settings_.l_min;
  least_keep_ = scene.contact.l_min ? most_keep_ : std::min(kMinKeep, most_keep_);
  recover_below_ = kRecoverBelow;
  X_ = at_.X;
  last_Y_ = held_part(scene).pose;
  blocking_.reserve(kMaxBlocking);
  near_.reserve(at_.spheres.size());
  known_.reserve(kMaxForces);
  guess_.reserve(kMaxForces);
}

bool ContactLoop::take_over(const TickReport& last, const Pose& Y, const std::vector<bool>* fresh,
                            std::int64_t deadline_ns) {
  if (!at_.is_path_free(X_, last.proxy.X, center_, fresh, deadline_ns, near_, blocking_)) return false;
  X_ = last.proxy.X;
  last_Y_ = Y;
  tracked_ = false;
  owed_.reset();
  keep_ = std::clamp(kKeepShare * last.contact_gap, least_keep_, most_keep_);
  return true;
}

void ContactLoop::stand_at(const Pose& X) {
  X_ = last_Y_ = X;
  at_.contacts->clear();
  near_.clear();
  at_.check->begin(near_, kNoDeadline);  // nothing is near: what the check knew of parts that were goes
  tracked_ = was_cut_ = comes_ = looked_ = false;
  owed_.reset();
  keep_ = most_keep_;
  trust_ = piece_cap_;
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
  // The pen's motion is followed within the tick, an older lag at twice its pace over the next ticks.
  const double travel = std::max(piece_cap_, kCatchUp * pen);
  if (at_.look_at_start(X_)) tracked_ = false;
  at_.query(X_, center_, std::min(wanted, travel) + at_.reach, near_);
  report.candidate_parts = static_cast<int>(near_.size());
  held_by_contacts_ = false;
  known_.clear();
  allowed_ = wanted;
  made_ = 0;
  if (near_.empty()) {
    X_ = displaced(X_, center_, std::min(1.0, travel / wanted) * displacement(X_, Y, center_));
    if (wanted <= travel) X_ = Y;
    report.substeps.push_back(X_);
    at_.contacts->clear();
    tracked_ = false;
    owed_.reset();
  } else {
    at_.check->begin(near_, deadline_ns_);
    if (track()) adapt_keep(Y);
    trust_ = std::max(trust_, kMinTrust);
    if (!was_cut_) trust_ = std::max(trust_, std::min(piece_cap_, kPenShare * pen));
    int shorter = 0;
    for (int i = 0; i < kMaxMotions && made_ < travel && !late(); ++i) {
      const double cap = std::min({trust_, piece_cap_, travel - made_});
      const double length = move_piece(Y, cap, report);
      if (length > 0) report.substeps.push_back(X_);
      // A piece shorter than it could be is the resolver's own end, but where planes of a longer motion made it short.
      if (length < kFullShare * cap && !(held_by_planes_ && ++shorter <= kMaxShorter)) break;
      made_ += length;
    }
    if (report.substeps.empty()) report.substeps.push_back(X_);
    if (!late()) track();
  }
  at_.tell(keep_ / kKeepShare, report);
  // Where the kept gap has shrunk, contacts may hold the part a little above it.
  if (report.contacts == 0 && wanted > keep_ && report.gap <= *settings_.l_min) at_.tell(*settings_.l_min, report);
  const Displacement moved = displacement(X_before, X_, center_);
  moved_ = size(moved);
  const double left = size(displacement(X_, Y, center_));
  report.lag_reason = reason_for(left, report);
  // Whatever holds the part back, the hand feels it. Nothing does where it goes as fast as it may: after a change that
  // took away what it touched it comes back to the pen through the air.
  comes_ = near_.empty() || made_ >= kFullShare * travel;
  report.proxy.touching = report.contacts > 0 || (report.lag_reason != LagReason::none && !comes_ && left > keep_);
  report.fraction = wanted > kRest ? std::clamp(1 - left / wanted, 0.0, 1.0) : 1;
  report.proxy.X = X_;
  report.proxy.velocity = dt > 0 ? Twist{moved.dp / dt, moved.dr / dt} : Twist{};
  report.flags.timed_out |= late();
  was_cut_ = report.flags.timed_out;
  tell_forces(Y, report);
  tell_slip(moved, report.forces);
  report.flags.timed_out |= late();  // forces with friction may have run out of time
  // What the tick leaves over gets ready for the first touch.
  if (!near_.empty() && deadline_ns_ != kNoDeadline && report.gap > kNearGap) {
    const Displacement to_pen = displacement(X_, Y, center_);
    at_.check->prepare(X_, {to_pen.dp + pen_moved.dp, to_pen.dr + pen_moved.dr},
                       deadline_ns_ - static_cast<std::int64_t>(1e9 * (1 - kPrepareShare) * settings_.tick_budget));
  }
}

void ContactLoop::tell_forces(const Pose& Y, TickReport& report) {
  report.planes.count = 0;
  report.forces = {};
  // Where X is not what the coupling's law gives, the wrench is not the contacts', and planes would make it another X.
  if (!resolver_->projects()) return;
  if (tracked_) {
    metric_.set_orientation(X_.q);
    planes_.pick(at_.contacts->limits(), metric_, friction_, X_, Y, center_, keep_, known_forces(), deadline_ns_,
                 report.planes, report.forces);
  } else {
    // Out of time, the limits may be those of an earlier pose.
    report.forces.lag = planes_.pull(displacement(X_, Y, center_));
  }
  // What holds the part back is no contact, and the hand is to feel it: the servo must not follow the pen meanwhile.
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

void ContactLoop::adapt_keep(const Pose& Y) {
  // A wide gap makes certificates cheap, but in a fit that has no room for it the part sticks. There is room for a gap
  // when a motion exists that leaves twice as much everywhere; out of a hole there always is one, so a part that stands
  // wedged between opposite sides has none either. The gap never grows under a part at rest: it would push it about.
  const auto& limits = at_.contacts->limits();
  if (least_keep_ == most_keep_ || limits.empty() || ++ticks_ % kAdaptTicks != 0) return;
  const bool standing = moved_ < kStanding;
  const bool holds = standing && size(displacement(X_, Y, center_)) > most_keep_ && wedged();
  // Gaps that are a little short of the least one may lock a part that has room to turn out of where it stands.
  recover_below_ = holds && keep_ == least_keep_ ? kRecoverWedged : kRecoverBelow;
  if (holds) {
    keep_ = std::max(0.5 * keep_, least_keep_);
    return;
  }
  metric_.set_orientation(X_.q);
  rows_.clear();
  for (const Contact& c : limits) {
    if (c.age == kOneShotAge) continue;  // planes for one motion, not surfaces
    bounds_[static_cast<std::size_t>(rows_.rows())] = 2 * keep_ - c.gap;
    rows_.push_row(metric_.row(c));
  }
  const bool room = resolver_->resolve(rows_, bounds_.data(), Vec6::Zero()).status != ResolveStatus::infeasible;
  if (!room) keep_ = std::max(0.5 * keep_, least_keep_);
  if (room && !standing) keep_ = std::min(kKeepGrowth * keep_, most_keep_);
}

bool ContactLoop::wedged() const {
  const auto& limits = at_.contacts->limits();
  // Of many limits an even sample: neighbors in the list are of one side.
  const std::size_t stride = limits.size() / kMaxWedging + 1;
  const auto presses = [this](const Contact& c) { return c.age != kOneShotAge && c.gap <= keep_ / kKeepShare; };
  for (std::size_t i = 0; i < limits.size(); i += stride)
    for (std::size_t j = 0; j < i && presses(limits[i]); j += stride)
      if (presses(limits[j]) && limits[i].n.dot(limits[j].n) < kOpposite) return true;
  return false;
}

double ContactLoop::move_piece(const Pose& Y, double cap, TickReport& report) {
  held_by_planes_ = false;
  if (!track()) return 0;
  if (owed_) {
    take_in(*owed_);
    owed_.reset();
  }
  metric_.set_orientation(X_.q);
  Displacement error = displacement(X_, Y, center_);
  const double turn = error.dr.norm();
  if (turn > most_turn_) error.dr *= most_turn_ / turn;
  const Pose goal = turn > most_turn_ ? displaced(X_, center_, error) : Y;
  const Vec6 wanted = metric_.whiten(error);
  Trial trial;
  bool free = false;
  for (int i = 0; i < kMaxResolves; ++i) {
    if (late() || !resolve(wanted, cap, report, trial)) return 0;
    if (size(trial.d) < kRest) {
      if (i + 1 < kMaxResolves && look_around()) continue;
      held_by_contacts_ = only_contacts();
      if (!resolver_->projects()) trust_ *= 0.5;
      if (cutting()) shorter_than(cap);
      return 0;
    }
    free = is_free(trial, report);
    if (free) break;
    if (late() && !blocking_.empty()) owed_ = trial.d;
    if ((blocking_.empty() || late()) && at_.check->free_share() > 0) {
      // Out of time or work: what is proved of the motion is made, and the next piece is not much longer, or as long as
      // all that was proved in this tick.
      scale(trial, at_.check->free_share());
      trust_ = std::max({kProvedGrowth * size(trial.d), made_ + size(trial.d), kMinTrust});
      X_ = trial.X;
      tracked_ = false;
      allowed_ = std::max(0.0, allowed_ - size(trial.d));
      return size(trial.d);
    }
    if (late()) {
      trust_ = 0.5 * std::min(trust_, size(trial.d));
      return 0;
    }
    if (!take_in(trial.d)) break;
  }
  if (!free) {
    trust_ = 0.5 * std::min(trust_, size(trial.d));
    if (!shorten(trial, report)) return 0;
  }
  const bool worth = worth_it(wanted, trial, goal);
  if (cutting() && (!worth || size(trial.d) < kWorthwhile * cap)) shorter_than(cap);
  if (!worth) {
    held_by_contacts_ = only_contacts();
    look_around();
    return 0;
  }
  X_ = trial.X;
  tracked_ = looked_ = false;
  allowed_ = std::max(0.0, allowed_ - size(trial.d));
  return size(trial.d);
}

bool ContactLoop::take_in(const Displacement& d) {
  return at_.contacts->seed(blocking_, at_.check->near_contact(X_, d, blocking_), deadline_ns_) > 0 ||
         at_.contacts->cut(blocking_, d, kGapFloor, deadline_ns_) > 0;
}

bool ContactLoop::look_around() {
  // Pieces need leave the certificate's clearance only, so that a part may have come to rest nearer to a surface that
  // was in no piece's way than to the contacts that hold it.
  if (looked_ || moved_ > kStanding || cutting()) return false;
  looked_ = true;
  blocking_.clear();
  at_.check->check(X_, {}, kRecoverBelow * keep_, blocking_);
  return at_.contacts->seed(blocking_, X_, deadline_ns_) > 0;
}

void ContactLoop::shorter_than(double cap) {
  trust_ = kShorter * std::min(trust_, cap);
  held_by_planes_ = true;
  tracked_ = false;  // tracking forgets the planes
}

bool ContactLoop::cutting() const {
  const auto& limits = at_.contacts->limits();
  return std::any_of(limits.begin(), limits.end(), [](const Contact& c) { return c.age == kOneShotAge; });
}

void ContactLoop::mark_carriers(const Vec6& motion) {
  far_planes_ = false;
  for (int i = 0; i < rows_.rows(); ++i)
    if (rows_.row(i).dot(motion) <= bounds_[static_cast<std::size_t>(i)] + kRest) carries(static_cast<std::size_t>(i));
}

void ContactLoop::carries(std::size_t i) {
  at_.contacts->carries(i);
  if (!far_planes_ && at_.contacts->limits()[i].age == kOneShotAge)
    far_planes_ = !at_.contacts->touches(i, keep_ / kKeepShare);
}

LagReason ContactLoop::reason_for(double lag, const TickReport& report) const {
  TickEnd end;
  end.lag = lag;
  end.bound = lag_bound(at_.radius);
  end.contacts = report.contacts;
  end.held_by_contacts = held_by_contacts_;
  end.allowed = allowed_;
  end.late = late();
  end.moved = moved_ > kRest;
  return lag_reason(end);
}

bool ContactLoop::resolve(const Vec6& wanted, double cap, TickReport& report, Trial& trial) {
  Vec6 motion = wanted;
  bool rubs = false;
  if (!at_.contacts->limits().empty()) {
    rubs = friction_.fill(at_.contacts->limits(), metric_);
    if (!(rubs ? solve_with_friction(wanted, report, motion) : solve(wanted, report, motion))) return false;
    // Cutting planes between triangles that do not touch explain no lag.
    if (only_contacts()) allowed_ = size(metric_.unwhiten(motion));
    if (!resolver_->projects() && !try_shorter_ways(wanted, cap, report, motion)) return false;
  }
  trial.d = metric_.unwhiten(motion);
  const double length = size(trial.d);
  if (length > cap) {
    // The direction is that of the whole way; its gaps are set right again at the length that is made, or a long way
    // would leave nearly nothing of their recovery.
    const Vec6 scaled = (cap / length) * motion;
    motion = scaled;
    if (!rubs && !at_.contacts->limits().empty() && !solve(scaled, report, motion)) motion = scaled;
  }
  // What is left of a longer way would see no load and so no friction; its gaps are set right without any.
  if (rubs) recover_gaps(report, motion);
  trial.d = metric_.unwhiten(motion);
  trial.X = displaced(X_, center_, trial.d);
  return true;
}

bool ContactLoop::try_shorter_ways(const Vec6& wanted, double cap, TickReport& report, Vec6& motion) {
  const double far = size(metric_.unwhiten(wanted));
  Vec6 best = motion;
  for (double way = std::min(cap, far); way > keep_ && size(metric_.unwhiten(best)) < kWorthwhile * way;
       way *= kShorter) {
    if (!solve((way / far) * wanted, report, motion)) return false;
    if (motion.dot(wanted) > best.dot(wanted)) best = motion;
  }
  motion = best;
  return true;
}

bool ContactLoop::solve(const Vec6& wanted, TickReport& report, Vec6& motion) {
  const auto& limits = at_.contacts->limits();
  rows_.clear();
  for (const Contact& c : limits) rows_.push_row(metric_.row(c));
  // Gaps that were lost to rounding or curvature recover where the program allows it; without recovery it has an
  // answer, because standing still is one, but for rounding. Between walls without room that may be the only one, by
  // rounding too.
  bool only_stands = false;
  for (const auto& [recovery, slack] : {std::pair(kRecovery * keep_, 0.0), {0.0, 0.0}, {0.0, kNormalNoise}}) {
    const double give = slack * wanted.norm();
    for (std::size_t i = 0; i < limits.size(); ++i) {
      bounds_[i] = bound_of(limits[i], keep_, recover_below_, recovery) - give;
    }
    const Resolution r = resolver_->resolve(rows_, bounds_.data(), wanted);
    ++report.resolves;
    report.iterations += r.iterations;
    report.status = r.status;
    motion = r.motion;
    if (only_stands && (r.status != ResolveStatus::solved || motion.norm() < kAlongShare * wanted.norm())) break;
    if (r.status != ResolveStatus::solved) continue;
    // Gaps between nearly parallel limits may ask for a long way, even back out of a hole: they are not worth it.
    const bool away = r.motion.squaredNorm() > 2 * wanted.dot(r.motion);
    if (recovery != 0 && away && size(metric_.unwhiten(r.motion)) >= kMaxRecovery * keep_) continue;
    only_stands = recovery == 0 && slack == 0 && resolver_->projects() && motion.norm() < kRest &&
                  wanted.norm() > kRest && wedged();
    if (only_stands) continue;
    mark_carriers(motion);
    return true;
  }
  if (!only_stands) return false;
  motion.setZero();
  report.status = ResolveStatus::solved;
  mark_carriers(motion);
  return true;
}

bool ContactLoop::is_free(const Trial& trial, TickReport& report) {
  blocking_.clear();
  const MotionAnswer answer = at_.check->check(X_, trial.d, kGapFloor, blocking_);
  report.flags.timed_out |= answer == MotionAnswer::unknown;
  return answer == MotionAnswer::free;
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
  // The program sees flat limits. Where they curve, the error that it promises to take away does not all go, or even
  // grows: near the end of the way such steps would swing to and fro for ever.
  const Vec6 step = metric_.whiten(trial.d);
  const double promised = error.squaredNorm() - (error - step).squaredNorm();
  if (promised <= 0) return true;  // a step that only opens gaps
  const double made = error.squaredNorm() - metric_.whiten(displacement(trial.X, Y, center_)).squaredNorm();
  if (made < kPoor * promised) trust_ = 0.5 * std::min(trust_, size(trial.d));
  if (made > kGood * promised) trust_ = std::min(2 * trust_, piece_cap_);
  return made > kStiction * still_ticks_ * error.squaredNorm();
}

}  // namespace tegotae
