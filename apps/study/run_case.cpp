#include "study/run_case.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "core/numbers.hpp"
#include "loop/inward_offset.hpp"
#include "loop/lag.hpp"
#include "loop/scene_parts.hpp"
#include "mesh/surface.hpp"
#include "review/verdict.hpp"
#include "session/run_goal.hpp"
#include "shared/blocked_text.hpp"
#include "shared/blocker_watch.hpp"
#include "shared/clearance_probe.hpp"
#include "shared/format.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/core/version.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/session/session.hpp"

namespace tegotae::study {
namespace {

// How far off (standard deviation in each direction) a part is brought to the rim, m on a radius of 25 mm, and how it
// is tilted; one that is pulled out is pulled a little askew only.
constexpr double kOffset = 1e-3, kOffsetRadius = 0.025, kTilt = 2 * kDegree;
constexpr double kPullOffset = 0.2e-3, kPullTilt = 0.5 * kDegree;
// Of a leg's end, the rest is the next leg's.
constexpr double kLegEnd = 1e-3, kLegEndAngle = 0.1;
// Of the held part's radius: the way between two looks at its clearance.
constexpr double kLookStep = 0.01;
constexpr std::uint64_t kStepSalt = 0x9e3779b9;  // so that the tasks of an order draw other numbers

/// Does the tasks of a route one after the other.
class RouteHand final : public InputSource {
 public:
  RouteHand(const OperatorProfile& profile, const Route& route, const Vec3& center, std::mt19937_64& rng)
      : center_(center), legs_(route.legs) {
    for (const InsertionTask& leg : legs_) operators_.push_back(std::make_unique<Operator>(profile, leg, rng()));
  }

  double begin() const noexcept override { return 0; }
  Pose start() const noexcept override { return operators_.front()->start(); }
  HandTarget target(double t, const Pose& pen) noexcept override { return operators_[leg_]->target(t - began_, pen); }

  void see(double t, const Pose& X) noexcept {
    const Displacement rest = displacement(X, legs_[leg_].goal, center_);
    if (leg_ + 1 < legs_.size() && rest.dp.norm() < kLegEnd && rest.dr.norm() < kLegEndAngle) {
      ++leg_;
      began_ = t;
    }
    operators_[leg_]->see(t - began_, X);
  }
  bool stuck() const noexcept { return operators_[leg_]->stuck(); }

 private:
  Vec3 center_;
  std::vector<InsertionTask> legs_;
  std::vector<std::unique_ptr<Operator>> operators_;
  std::size_t leg_ = 0;
  double began_ = 0;  // the leg, s
};

/// The least distance to the other parts on the way. Asks only where it may have become less.
class LeastClearance {
 public:
  LeastClearance(const Scene& scene, const Vec3& center)
      : probe_(scene), center_(center), radius_(radius_about(*held_part(scene).mesh, center)) {}

  void look(const Pose& X, bool always) {
    if (asked_ && !always) {
      const Displacement way = displacement(last_, X, center_);
      const double moved = way.dp.norm() + radius_ * way.dr.norm();
      if (moved < kLookStep * radius_ || distance_ - moved >= least_) return;
    }
    asked_ = true;
    last_ = X;
    probe_.at(X, 0, near_);
    distance_ = near_.empty() ? INFINITY : near_.front().distance;
    least_ = std::min(least_, distance_);
  }
  double least() const { return least_; }

 private:
  apps::ClearanceProbe probe_;
  Vec3 center_;
  double radius_;
  std::vector<apps::Clearance> near_;
  bool asked_ = false;
  Pose last_;
  double distance_ = 0, least_ = INFINITY;
};

/// Shows the part to the operator, and ends the case when the part has stayed at its goal.
class Watcher final : public RunObserver {
 public:
  Watcher(const Scene& scene, const Vec3& center, RouteHand& hand, const RunGoal& goal, const std::atomic<bool>& stop,
          Result& result)
      : hand_(hand), goal_(goal), stop_(stop), result_(result), clearance_(scene, center) {}

  void before_tick(double) override {}
  void after_tick(const TickView& tick) noexcept override {
    const TickReport& report = tick.loop.report();
    const Pose& X = report.proxy.X;
    hand_.see(tick.t, X);
    result_.stuck += hand_.stuck() ? 1e-3 : 0;
    const bool there = goal_.reached(X) && !held_up(report.lag, tick.loop.lag_bound(), report.lag_reason);
    if (!there) since_ = -1;
    if (there && since_ < 0) since_ = tick.t;
    result_.time = there ? since_ : tick.t;
    settled_ = there && tick.t - since_ >= kSettleTime;
    if (settled_ || stop_.load(std::memory_order_relaxed)) end = true;
    blocker_.after_tick(tick);
    clearance_.look(X, end);
  }
  /// The part has stayed at its goal: nothing was left to do.
  bool settled() const { return settled_; }
  double clearance() const { return clearance_.least(); }
  apps::Blocker blocker(const Scene& scene, const InitialContactReport& start) const {
    return blocker_.find(scene, start);
  }

  std::atomic<bool> end{false};

 private:
  RouteHand& hand_;
  const RunGoal& goal_;
  const std::atomic<bool>& stop_;
  Result& result_;
  apps::BlockerWatch blocker_;
  LeastClearance clearance_;
  double since_ = -1;  // when the part came to its goal, s
  bool settled_ = false;
};

/// Adds one task of a case to what there is.
void add(const Result& one, Result& r) {
  r.who = one.who;
  r.route = one.route;
  r.offset = one.offset;
  r.tilt = one.tilt;
  r.reached = r.reached && one.reached;
  r.time += one.time;
  r.depth = one.depth;
  r.force = std::max(r.force, one.force);
  r.torque = std::max(r.torque, one.torque);
  r.stuck += one.stuck;
  r.intersecting += one.intersecting;
  r.blocked_by = one.blocked_by;
  r.place_W = one.place_W;
  r.clearance = std::min(r.clearance, one.clearance);
  r.why = one.why;
}

/// The route with its first leg's aim put astray: by the case's offset and tilt in a direction that is drawn, or by
/// what is drawn.
Route astray(Route route, double radius, const Case& c, std::mt19937_64& rng, Result& result) {
  std::normal_distribution<double> normal;
  InsertionTask& leg = route.legs.front();
  const Vec3 e1 = leg.inward.unitOrthogonal(), e2 = leg.inward.cross(e1);
  const auto across = [&](double size, const Value* given) -> Vec3 {
    const double a = normal(rng), b = normal(rng);
    const Vec3 v = a * e1 + b * e2;
    return given != nullptr ? Vec3(given->number * v.normalized()) : Vec3(size * v);
  };
  leg.offset = across((route.pulls ? kPullOffset : kOffset) * std::min(1.0, radius / kOffsetRadius), c.find("offset"));
  leg.tilt = across(route.pulls ? kPullTilt : kTilt, c.find("tilt"));
  result.offset = leg.offset.norm();
  result.tilt = leg.tilt.norm();
  return route;
}

/// Gives the scene what the case has of friction and of its parts' sizes. Whether a part changed.
bool change_scene(const Case& c, Scene& scene) {
  if (const Value* mu = c.find("mu")) {
    scene.friction = {};
    scene.friction.mu = mu->number;
  }
  bool changed = false;
  for (Part& part : scene.parts) {
    const Value* inward = c.find("inward " + part.name);
    if (inward == nullptr || inward->number == 0) continue;
    part.mesh = std::make_shared<TriangleMesh>(inward_offset(Surface(part.mesh), inward->number));
    changed = true;
  }
  return changed;
}

/// Why a task failed.
void tell_why(const RunSummary& summary, const apps::Blocker& blocker, Result& result) {
  if (summary.penetrating > 0) {
    result.why = apps::format("%lld poses intersect another part", static_cast<long long>(summary.penetrating));
    return;
  }
  result.blocked_by = blocker.part;
  result.place_W = blocker.place_W;
  result.why = apps::blocked_text(blocker);
}

/// What of a case one task needs.
struct Attempt {
  const Study& study;
  const Case& c;
  const std::atomic<bool>& stop;
  std::size_t step;
};

/// Adds how one task went; false when it was stopped.
bool run_task(const Task& task, const Attempt& a, const RecordTo& record_to, Result& result) {
  const auto n = static_cast<std::size_t>(a.c.repeat);
  const auto& people = operator_profiles();
  const Value* named = a.c.find("operator");
  const OperatorProfile& who =
      named != nullptr ? operator_profile(named->text) : people[(n / task.routes.size()) % people.size()];
  std::seed_seq seeds{static_cast<std::uint32_t>(a.study.seed), static_cast<std::uint32_t>(a.study.seed >> 32),
                      static_cast<std::uint32_t>(a.c.number + a.step * kStepSalt)};
  std::mt19937_64 rng(seeds);
  Result one;
  one.who = who.name;

  SceneFile file = task.file;
  const bool changed = change_scene(a.c, file.scene);
  const double radius = radius_about(*held_part(task.file.scene).mesh, task.center);
  const Route route = astray(task.routes[n % task.routes.size()], radius, a.c, rng, one);
  one.route = route.name;
  RouteHand hand(who, route, task.center, rng);
  file.device.hand = who.hand;
  file.script = StylusScript({{0, held_part(file.scene).pose}, {1, route.goal}});  // what the run is judged by
  const RunGoal goal(file, task.center);
  Watcher watcher(file.scene, task.center, hand, goal, a.stop, one);
  RunSettings settings;
  settings.real_time = false;
  settings.seconds = a.study.seconds;
  settings.hand = &hand;
  settings.observer = &watcher;
  settings.stop = &watcher.end;
  settings.check_all = true;  // the same result on any machine
  settings.stop_check = &a.stop;
  if (record_to) settings.record = record_to(file, a.step);
  settings.program = "tegotae " TEGOTAE_VERSION_STRING;
  try {
    const RunSummary summary = run_session(file, settings);
    if (!summary.record_failure.empty()) throw Error(summary.record_failure);
    one.reached = summary.completed && summary.penetrating == 0;
    // Also where it was at its goal, and had not stayed there: forces and times were not those of the whole run.
    if (a.stop && !watcher.settled()) return false;
    one.depth = summary.depth_m;
    one.force = summary.force_max_n;
    one.torque = summary.torque_max_nm;
    one.intersecting = summary.penetrating;
    one.clearance = watcher.clearance();
    if (!one.reached) tell_why(summary, watcher.blocker(file.scene, summary.start), one);
  } catch (const Error& e) {
    // A drawn size may leave no clearance at the start: the case failed.
    if (!changed || record_to) throw;
    one.why = e.what();
  }
  add(one, result);
  return true;
}

}  // namespace

std::optional<Result> run_case(const Study& study, Tasks& tasks, const Case& c, const std::atomic<bool>& stop,
                               const RecordTo& record_to) {
  Result result;
  result.number = c.number;
  result.parameters = parameter_cells(study, c);
  result.reached = true;
  result.clearance = INFINITY;
  std::size_t step = 0;
  for (const std::shared_ptr<const Task>& task : tasks.of(c)) {
    const Attempt attempt{study, c, stop, step};
    if (!run_task(*task, attempt, record_to, result)) return std::nullopt;
    if (!result.reached) break;  // what is behind it stays where it is
    ++step;
  }
  return result;
}

}  // namespace tegotae::study
