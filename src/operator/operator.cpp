#include "tegotae/operator/operator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "device/delayed_view.hpp"
#include "operator/minimum_jerk.hpp"
#include "operator/tremor.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

// How often the hand compares what it means to do with what it feels, s; reflexes through the spinal cord take 30
// to 50.
constexpr double kFeelPeriod = 0.05;
// Every so many of them it looks and aims again.
constexpr int kLookEvery = 4;
// Share of what it sees to be wrong that a look takes away. Looks come before the last one's effect is seen, so more
// would overshoot.
constexpr double kEyeGain = 0.3;
// Share of what the part pushes the hand aside that the hand gives way to at each look.
constexpr double kYield = 0.15;
// Offset (m) and tilt (rad) with which a person goes down on a hole without aiming again: the rim will guide the tip.
constexpr double kAcceptedOffset = 2e-3, kAcceptedTilt = 0.12;
// Where the hand wants tip and part never leads what it feels by more than its push takes on the grip's springs,
// sideways as far as into the hole, turning with this lever (m): one who cannot turn a part does not turn the hand ever
// further.
constexpr double kLever = 0.04;
// Looks in the air after which it goes down anyhow.
constexpr int kMaxLooks = 6;
// From this height on (m) the tip is at the surface to the eye.
constexpr double kAtSurface = 0.3e-3;
// Shortest piece of the path, s: 0.2 to 0.3 is a small submovement's time (Milner, J. Neurophysiol. 1992).
constexpr double kShortestPiece = 0.25;
// Progress (m) below which it is stuck, and what is left at the end that needs no wiggling.
constexpr double kProgress = 0.3e-3, kNearEnd = 1e-3;
// A part that is wedged between two sides comes free only when it is drawn back (Whitney, J. Dyn. Syst. Meas. Control
// 104, 1982): after so long without progress (s) the hand pulls for so long, as hard as it pushed, but not farther than
// so much (m), and tries again.
constexpr double kDrawBackAfter = 2, kDrawBackFor = 0.4, kDrawBackWay = 1e-3;
// A wiggle grows by this factor at each look without progress, to so many times the first; it fades by the last.
constexpr double kWiggleGrowth = 1.25, kMaxWiggle = 4, kWiggleFade = 0.6;
// Circles of the tip (m) for a tilt of 1 rad; turns of the circles against those of the tilt.
constexpr double kCircleShare = 8e-3, kCircleTurns = 0.73;

// Depth and aim are planned apart, so that a correction takes its own short time however long the way down is. The aim:
// offset of the tip across the hole (2, m), tilt (2, rad), size of the wiggle (rad). The depth of the tip is negative
// above the surface.
using Aim = MinimumJerk<5>;
using Depth = MinimumJerk<1>;
enum : int { kOffset = 0, kTilt = 2, kWiggle = 4 };

/// Where the held part is, or is wanted, in the task's own terms.
struct Place {
  Aim::Vector aim = Aim::Vector::Zero();
  double depth = 0;
};

Depth::Vector one(double x) {
  return Depth::Vector::Constant(x);
}

void require(bool good, const char* what) {
  if (!good) throw Error(ErrorKind::setting, std::string("operator: ") + what + " is out of range", {{}, 0, what, {}});
}

void check(const OperatorProfile& p, const InsertionTask& task) {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  const auto not_negative = [](double x) { return std::isfinite(x) && x >= 0; };
  require(positive(p.hand.stiffness) && positive(p.hand.torsional_stiffness), "hand stiffness");
  require(not_negative(p.tremor) && not_negative(p.tremor_angle), "tremor");
  require(positive(p.visual_delay) && p.visual_delay <= 0.4, "visual_delay");
  require(positive(p.carry_speed) && positive(p.insertion_speed), "speed");
  require(not_negative(p.aim_error) && not_negative(p.tilt_error), "aim or tilt error");
  require(not_negative(p.eye_error) && not_negative(p.eye_tilt_error), "eye's error");
  require(positive(p.press), "press");
  require(positive(p.patience), "patience");
  require(not_negative(p.wiggle), "wiggle");
  require(positive(task.depth), "the task's depth");
  require(not_negative(task.hover), "the task's hover");
  require(std::abs(task.inward.norm() - 1) < 1e-9, "the task's inward direction");
  require(task.start.p.allFinite() && task.goal.p.allFinite() && task.tip.allFinite(), "the task's start, goal or tip");
  require(task.offset.allFinite() && task.tilt.allFinite(), "the task's offset or tilt");
}

}  // namespace

struct Operator::Impl {
  Impl(const OperatorProfile& profile_in, const InsertionTask& task_in, std::uint64_t seed)
      : profile(profile_in),
        task(task_in),
        rng(seed),
        tremor(profile.tremor, profile.tremor_angle, rng),
        e1(task.inward.unitOrthogonal()),
        e2(task.inward.cross(e1)),
        rim(task.goal * task.tip - task.depth * task.inward) {
    std::uniform_real_distribution<double> u(0, 1);
    wiggle_hz = 1.5 + u(rng);  // comfortable hand shaking
    wiggle_phase = kTwoPi * u(rng);
    // The first reach is ballistic: its errors are seen only after it has ended.
    const Place from = place(task.start);
    Aim::Vector first = Aim::Vector::Zero();
    const double own = task.own_errors ? 1.0 : 0.0;
    for (int k = 0; k < 2; ++k) {
      const Vec3& e = k == 0 ? e1 : e2;
      first[kOffset + k] = task.offset.dot(e) + own * profile.aim_error * noise();
      first[kTilt + k] = task.tilt.dot(e) + own * profile.tilt_error * noise();
    }
    const Eigen::Vector2d across_way = (first - from.aim).segment<2>(kOffset);
    const double way = std::hypot(across_way.norm(), task.hover + from.depth);
    const double time = std::max(kShortestPiece, way / profile.carry_speed);
    aim_plan = Aim({from.aim, Aim::Vector::Zero(), Aim::Vector::Zero()}, first, 0, time);
    depth_plan = Depth({one(from.depth), one(0), one(0)}, one(-task.hover), 0, time);
    reach_ends = time + profile.visual_delay;
    start = pose(from);
  }

  double noise() { return normal(rng); }

  Place place(const Pose& X) const {
    const Vec3 tip = X * task.tip - rim, turn = rotation_vector(X.q * task.goal.q.conjugate());
    Place out;
    out.aim << tip.dot(e1), tip.dot(e2), turn.dot(e1), turn.dot(e2), 0;
    out.depth = tip.dot(task.inward);
    return out;
  }

  Vec3 across(const Aim::Vector& a, int k) const { return a[k] * e1 + a[k + 1] * e2; }

  Pose pose(const Place& at) const {
    Pose X;
    X.q = (rotation(across(at.aim, kTilt)) * task.goal.q).normalized();
    X.p = rim + across(at.aim, kOffset) + at.depth * task.inward - X.q * task.tip;
    return X;
  }

  void feel(double t, const Pose& pen) {
    if (t < reach_ends) return;
    const Place felt = place(pen);
    if (ticks++ % kLookEvery == 0) look(t, felt);
    if (!down) return;
    const Depth::State now = depth_plan.at(t);
    const double lead = profile.press / profile.hand.stiffness;
    const bool held_back = now.x[0] - felt.depth > lead;
    notice_progress(t, felt.depth, held_back);
    const bool back = draws_back(t, felt.depth);
    const double out = deepest - kDrawBackWay, pulled = felt.depth > out ? felt.depth - lead : out;
    const double target = back ? pulled : held_back ? felt.depth + lead : task.depth;
    // A way down that goes on is let be: planned again and again it would never speed up.
    if (!back && !held_back && depth_plan.target()[0] == task.depth) return;
    const double way = std::abs(target - now.x[0]);
    const double time = back || held_back ? kShortestPiece : std::max(kShortestPiece, way / profile.insertion_speed);
    depth_plan = Depth(now, one(target), t, time);
  }

  /// Aims again at what is seen and felt.
  void look(double t, const Place& felt) {
    const Pose* X = view.at(t - profile.visual_delay);
    if (!X) return;
    Place seen = place(*X);
    for (int k = 0; k < 2; ++k) {
      seen.aim[kOffset + k] += profile.eye_error * noise();
      seen.aim[kTilt + k] += profile.eye_tilt_error * noise();
    }
    const Aim::State now = aim_plan.at(t);
    Aim::Vector target = aim_plan.target();
    const bool at_surface = seen.depth > -kAtSurface;
    const bool good =
        seen.aim.segment<2>(kOffset).norm() < kAcceptedOffset && seen.aim.segment<2>(kTilt).norm() < kAcceptedTilt;
    if (!down && (good || ++looks >= kMaxLooks)) down = true;
    if (at_surface || !down) target.head<4>() -= kEyeGain * seen.aim.head<4>();
    if (at_surface) {
      target.head<4>() += kYield * (felt.aim - now.x).head<4>();
      hold_near(felt.aim, kOffset, profile.press / profile.hand.stiffness, target);
      hold_near(felt.aim, kTilt, profile.press * kLever / profile.hand.torsional_stiffness, target);
    }
    double& wiggle = target[kWiggle];
    wiggle =
        stuck ? std::clamp(kWiggleGrowth * wiggle, profile.wiggle, kMaxWiggle * profile.wiggle) : kWiggleFade * wiggle;
    aim_plan = Aim(now, target, t, kShortestPiece);
  }

  /// Takes the two coordinates of `target` from `k` on back to within `reach` of `felt`.
  static void hold_near(const Aim::Vector& felt, int k, double reach, Aim::Vector& target) {
    const Eigen::Vector2d lead = target.segment<2>(k) - felt.segment<2>(k);
    if (lead.norm() > reach) target.segment<2>(k) = felt.segment<2>(k) + reach / lead.norm() * lead;
  }

  void notice_progress(double t, double depth, bool held_back) {
    if (depth > deepest + kProgress) {
      deepest = depth;
      progress_at = t;
    }
    stuck = held_back && t - progress_at > profile.patience && depth < task.depth - kNearEnd;
  }

  bool draws_back(double t, double depth) const {
    // What it pulls out goes in again as deep as it was without being progress.
    return depth < task.depth - kNearEnd && std::fmod(t - progress_at, kDrawBackAfter + kDrawBackFor) > kDrawBackAfter;
  }

  HandTarget target(double t, const Pose& pen) {
    while (t >= next_feel) {
      feel(next_feel, pen);
      next_feel += kFeelPeriod;
    }
    Aim::State s = aim_plan.at(t);
    const Depth::State d = depth_plan.at(t);
    // A wiggle tilts the part around and leads its tip on circles of another frequency.
    const double rate = kTwoPi * wiggle_hz, a = rate * t + wiggle_phase, size = s.x[kWiggle], swell = s.v[kWiggle];
    const double b = kCircleTurns * a, circle = kCircleShare * size, circle_swell = kCircleShare * swell;
    const Eigen::Vector2d round(std::cos(a), std::sin(a)), tip_round(std::cos(b), std::sin(b));
    s.x.segment<2>(kTilt) += size * round;
    s.x.segment<2>(kOffset) += circle * tip_round;
    s.v.segment<2>(kTilt) += swell * round + size * rate * Eigen::Vector2d(-round.y(), round.x());
    s.v.segment<2>(kOffset) +=
        circle_swell * tip_round + circle * kCircleTurns * rate * Eigen::Vector2d(-tip_round.y(), tip_round.x());

    const Tremor::Value shake = tremor.at(t);
    HandTarget out;
    const Pose steady = pose({s.x, d.x[0]});
    const Vec3 tip = steady * task.tip;
    out.pose.q = (rotation(shake.d.dr) * steady.q).normalized();
    out.pose.p = tip + shake.d.dp - out.pose.q * task.tip;
    // Tilts are small: the rate of the rotation vector is the angular velocity up to the square of the tilt.
    out.velocity.w = across(s.v, kTilt) + shake.rate.w;
    const Vec3 tip_velocity = across(s.v, kOffset) + d.v[0] * task.inward + shake.rate.v;
    out.velocity.v = tip_velocity + out.velocity.w.cross(out.pose.p - (tip + shake.d.dp));
    return out;
  }

  OperatorProfile profile;
  InsertionTask task;
  std::mt19937_64 rng;
  std::normal_distribution<double> normal;
  Tremor tremor;
  Vec3 e1, e2;  // across the hole
  Vec3 rim;     // where the hole's axis meets the surface
  Pose start;
  DelayedView view;
  Aim aim_plan;
  Depth depth_plan;
  double reach_ends = 0;  // when the first reach has been seen to its end, s
  double next_feel = 0;
  int ticks = 0, looks = 0;
  bool down = false;  // it has decided to go down into the hole
  double deepest = -std::numeric_limits<double>::infinity(), progress_at = 0;  // m, s
  bool stuck = false;
  double wiggle_hz = 0, wiggle_phase = 0;
};

Operator::Operator(const OperatorProfile& profile, const InsertionTask& task, std::uint64_t seed)
    : impl_((check(profile, task), std::make_unique<Impl>(profile, task, seed))) {}
Operator::~Operator() = default;

void Operator::see(double t, const Pose& X) noexcept {
  impl_->view.add(t, X);
}
Pose Operator::start() const noexcept {
  return impl_->start;
}
HandTarget Operator::target(double t, const Pose& pen) noexcept {
  return impl_->target(t, pen);
}
bool Operator::stuck() const noexcept {
  return impl_->stuck;
}

}  // namespace tegotae
