#include "loop/impulse_loop.hpp"

#include <algorithm>
#include <cmath>

#include "loop/scene_parts.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

// Gap at which contacts collide (m): under half of 5 µm radial clearance, over what the certificate asks for.
constexpr double kEnvelope = 2e-6;
// Time steps longer than this (s) are a pause, not motion.
constexpr double kLongestTick = 0.02;
// Impulses of a sub-step; a part wedged between contacts would go on for ever. Gaps are recovered in the first of them
// only: those of opposite sides may not recover at once.
constexpr int kMaxImpulses = 100, kRecovering = 30;
// Sub-steps of a tick; each goes to the next collision.
// New constraints looked for on one sub-step of the way before it is shortened.
constexpr int kMaxSearches = 6;
constexpr int kMaxHalvings = 4;
constexpr std::size_t kMaxImpulseBlocking = 256;
// Share of the envelope that a contact may lose in a sub-step before it counts as a collision: impulses at other
// contacts leave speeds that die away but never vanish.
constexpr double kSlack = 0.05;
// Share of a lost gap that one sub-step recovers.
constexpr double kRecovery = 0.2;
// See ContactLoop: planes for one motion alone leave this many times the certificate's clearance.
constexpr double kCutMargin = 1.2;
// A motion that carries no point farther than this (m) is rest.
constexpr double kImpulseRest = 1e-10;
// No hand takes a part along faster (m/s, of any of its points); without a bound a pen that jumps by kilometers makes
// spins that Euler's equation, taken explicitly, drives past every number.
constexpr double kFastest = 100;
// Bends a motion at most so far from the sum of its constraints' straight lines (rad a sub-step).
constexpr double kMaxTurn = 0.1;

}  // namespace

ImpulseLoop::ImpulseLoop(const Scene& scene, const ContactSettings& settings, const MassProperties& mass)
    : settings_(settings),
      coupling_(scene.coupling),
      mass_(mass),
      at_(scene, settings, mass),
      envelope_(std::min(kEnvelope, 0.5 * *settings.l_min)),
      substep_cap_(at_.check->longest_motion()) {
  X_ = at_.X;
  last_Y_ = held_part(scene).pose;
  blocking_.reserve(kMaxImpulseBlocking);
  near_.reserve(at_.spheres.size());
}

bool ImpulseLoop::take_over(const TickReport& last, const Pose& Y, const std::vector<bool>* fresh,
                            std::int64_t deadline_ns) {
  if (!at_.is_path_free(X_, last.proxy.X, mass_.center, fresh, deadline_ns, near_, blocking_)) return false;
  X_ = last.proxy.X;
  V_ = last.proxy.velocity;
  last_Y_ = Y;
  tracked_ = false;
  return true;
}

void ImpulseLoop::step(const Pose& Y, double dt, std::int64_t deadline_ns, TickReport& report) {
  collided_ = stuck_ = false;
  deadline_ns_ = deadline_ns;
  if (at_.poll_initial_contacts(X_)) tracked_ = false;
  const double time = std::clamp(dt, 0.0, kLongestTick);
  const int n = std::max(1, static_cast<int>(std::ceil(time / settings_.impulse.substep - 1e-9)));
  const double h = time / n;
  const Displacement travel = displacement(last_Y_, Y, mass_.center);
  const double wanted = size(displacement(X_, Y, mass_.center));
  if (h > 0) {
    const Twist pen{travel.dp / time, travel.dr / time};
    for (int i = 1; i <= n && !late() && report.substeps.size() < kMaxSubsteps; ++i) {
      accelerate(displaced(last_Y_, mass_.center, (static_cast<double>(i) / n) * travel), pen, h);
      substep(h, report);
    }
  }
  last_Y_ = Y;
  if (report.substeps.empty()) report.substeps.push_back(X_);
  gather(Y, wanted, report);
}

bool ImpulseLoop::late() const {
  return past(deadline_ns_);
}

void ImpulseLoop::accelerate(const Pose& Y, const Twist& pen, double h) {
  const Twist before = V_;
  const Displacement e = displacement(X_, Y, mass_.center);
  const CouplingSettings& c = coupling_;
  V_.v = (mass_.mass * V_.v + h * (c.stiffness * e.dp + c.damping * pen.v)) /
         (mass_.mass + h * h * c.stiffness + h * c.damping);
  const Mat3 R = X_.q.toRotationMatrix();
  const Mat3 inertia = R * mass_.inertia * R.transpose();
  inverse_inertia_W_ = inertia.inverse();
  const double torsional = h * h * c.torsional_stiffness + h * c.torsional_damping;
  V_.w = (inertia + torsional * Mat3::Identity())
             .ldlt()
             .solve(inertia * V_.w - h * V_.w.cross(inertia * V_.w) +
                    h * (c.torsional_stiffness * e.dr + c.torsional_damping * pen.w));
  const double fast = V_.v.norm() + at_.radius * V_.w.norm();
  if (fast > kFastest) V_ = {kFastest / fast * V_.v, kFastest / fast * V_.w};
  gained_ = {V_.v - before.v, V_.w - before.w};
}

void ImpulseLoop::substep(double h, TickReport& report) {
  const double far = h * (V_.v.norm() + at_.radius * V_.w.norm());
  at_.query(X_, mass_.center, far + at_.reach, near_);
  report.candidate_parts = std::max(report.candidate_parts, static_cast<int>(near_.size()));
  if (near_.empty()) {
    X_ = displaced(X_, mass_.center, {h * V_.v, h * V_.w});
    report.substeps.push_back(X_);
    at_.contacts->clear();
    tracked_ = false;
    return;
  }
  at_.check->begin(near_, deadline_ns_, OtherParts::far);
  tracked_ = false;  // planes for motions of the last sub-step are of no more use
  double left = h;
  int impulses = 0, searches = 0;
  while (left > 0 && !late() && report.substeps.size() < kMaxSubsteps) {
    if (!tracked_) tracked_ = at_.contacts->track(X_, at_.reach, deadline_ns_);
    if (!tracked_) break;  // out of time
    Collision next;
    next.time = left;
    recovery_ = impulses < kRecovering ? kRecovery / h : 0;
    if (impulses < kMaxImpulses) next = next_collision(left);
    double time = next.constraint < 0 ? left : next.time;
    if (time > 0) {
      const bool search = searches < kMaxSearches && impulses < kMaxImpulses;
      const Advance outcome = advance(search, time, report);
      if (outcome == Advance::found) {
        ++searches;
        continue;
      }
      if (outcome == Advance::stuck) {
        stuck_ = true;
        // What cannot go on is at rest. With its speed kept the coupling would pull it up in every sub-step, to a meter
        // a second of a part that stands still, and no number of impulses would take that off.
        if (!late()) V_ = {};
        break;
      }
      left -= time;
      searches = 0;
      continue;  // the constraints are followed to here first; the nearest of them collides
    }
    collide(next);
    ++report.iterations;
    if (++impulses == kMaxImpulses) report.status = ResolveStatus::stalled;
    if (report.status == ResolveStatus::not_needed) report.status = ResolveStatus::solved;
  }
}

double ImpulseLoop::floor(const Contact& c) const {
  return c.age == kOneShotAge ? kCutMargin * kGapFloor : envelope_;
}

double ImpulseLoop::opening_speed(const Contact& c) const {
  const double lost = c.age == kOneShotAge ? 0 : floor(c) - c.gap;
  return lost > kSlack * envelope_ ? recovery_ * lost : 0;
}

ImpulseLoop::Collision ImpulseLoop::next_collision(double time) const {
  Collision next;
  next.time = time;
  const auto& constraints = at_.contacts->constraints();
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const Contact& c = constraints[i];
    const double v = speed(c), slack = kSlack * envelope_, room = c.gap - floor(c);
    const double approach = opening_speed(c) - v;
    if (approach <= 0 || room - approach * time > -slack) continue;
    const double t = std::max(0.0, room) / approach;
    // At the same time the one that closes fastest.
    const bool now = room < slack;
    const double when = now ? 0.0 : t;
    if (next.constraint >= 0 && (when > next.time || (when == next.time && approach <= next.approach))) continue;
    next = {static_cast<int>(i), when, approach};
  }
  return next;
}

void ImpulseLoop::collide(const Collision& collision) {
  const Contact& c = at_.contacts->constraints()[static_cast<std::size_t>(collision.constraint)];
  const Vec3 arm = c.r.cross(c.n);
  const double v = speed(c);
  // What the coupling itself has added in this sub-step is pressure, not an impact.
  const double pressed = std::max(0.0, -c.n.dot(gained_.v + gained_.w.cross(c.r)));
  const bool impact = -v > settings_.impulse.micro_speed + pressed;
  const double after = std::max(opening_speed(c), impact ? -settings_.impulse.restitution * v : 0.0);
  const double impulse = (after - v) / (1 / mass_.mass + arm.dot(inverse_inertia_W_ * arm));
  V_.v += impulse / mass_.mass * c.n;
  V_.w += impulse * (inverse_inertia_W_ * arm);
  collided_ = true;
}

ImpulseLoop::Advance ImpulseLoop::advance(bool search, double& time, TickReport& report) {
  const double length = time * (V_.v.norm() + at_.radius * V_.w.norm());
  if (length < kImpulseRest) return Advance::made;
  time *= std::min({1.0, substep_cap_ / length, kMaxTurn / std::max(kMaxTurn, time * V_.w.norm())});
  for (int i = 0; i <= kMaxHalvings && !late(); ++i, time *= 0.5) {
    const Displacement d{time * V_.v, time * V_.w};
    blocking_.clear();
    const MotionAnswer answer = at_.check->check(X_, d, kGapFloor, blocking_);
    if (answer == MotionAnswer::free) {
      X_ = displaced(X_, mass_.center, d);
      report.substeps.push_back(X_);
      tracked_ = false;
      return Advance::made;
    }
    report.flags.timed_out |= answer == MotionAnswer::unknown;
    if (search && i == 0 && answer == MotionAnswer::blocked &&
        (at_.contacts->seed(blocking_, at_.check->near_contact(X_, d, blocking_), deadline_ns_) > 0 ||
         at_.contacts->add_cutting_planes(blocking_, d, kGapFloor, deadline_ns_) > 0))
      return Advance::found;
  }
  return Advance::stuck;
}

void ImpulseLoop::gather(const Pose& Y, double wanted, TickReport& report) const {
  at_.fill_report(2 * envelope_, report);
  report.flags.timed_out |= late();
  const double left = size(displacement(X_, Y, mass_.center));
  report.fraction = wanted > kImpulseRest ? std::clamp(1 - left / wanted, 0.0, 1.0) : 1;
  // A part with inertia trails in free space, which needs no reason; one that cannot go on has none to trail for.
  const bool held = report.contacts > 0 || collided_;
  report.lag_reason = left <= kImpulseRest     ? LagReason::none
                      : held                   ? LagReason::contact
                      : report.flags.timed_out ? LagReason::time
                      : stuck_                 ? LagReason::capacity
                                               : LagReason::none;
  report.proxy.touching = held || report.lag_reason != LagReason::none;
  report.proxy.X = X_;
  report.proxy.velocity = V_;
}

}  // namespace tegotae
