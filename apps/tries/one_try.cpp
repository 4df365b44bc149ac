#include "tries/one_try.hpp"

#include <algorithm>
#include <deque>
#include <map>
#include <memory>
#include <random>

#include "broadphase/bounding_spheres.hpp"
#include "loop/scene_parts.hpp"
#include "session/run_goal.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/core/version.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/session/session.hpp"

namespace tegotae::tries {
namespace {

constexpr double kDegree = 0.017453292519943295;
// How far off (standard deviation in each direction) a part is brought to the rim, m on a radius of 25 mm, and how it
// is tilted; one that is pulled out is pulled a little askew only.
constexpr double kOffset = 1e-3, kOffsetRadius = 0.025, kTilt = 2 * kDegree;
constexpr double kPullOffset = 0.2e-3, kPullTilt = 0.5 * kDegree;
// Of a leg's end, the rest is the next leg's.
constexpr double kLegEnd = 1e-3, kLegEndAngle = 0.1;
constexpr double kLooksBack = 0.5;  // s, for what is in the way at the end

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

/// Shows the part to the operator, and ends the try when the part has stayed at its goal.
class Watcher final : public RunObserver {
 public:
  Watcher(const Scene& scene, RouteHand& hand, const RunGoal& goal, const std::atomic<bool>& stop, Result& result)
      : hand_(hand), goal_(goal), stop_(stop), result_(result) {
    for (const Part& part : scene.parts) names_.push_back(part.name);
  }

  void before_tick(double) override {}
  void after_tick(const TickView& tick) noexcept override {
    const Pose& X = tick.loop.report().proxy.X;
    hand_.see(tick.t, X);
    result_.stuck += hand_.stuck() ? 1e-3 : 0;
    note_contacts(tick);
    const bool there = goal_.reached(X);
    if (!there) since_ = -1;
    if (there && since_ < 0) since_ = tick.t;
    result_.reached = there && tick.t - since_ >= kSettleTime;
    result_.time = there ? since_ : tick.t;
    if (result_.reached || stop_.load(std::memory_order_relaxed)) end = true;
  }

  /// Who is in the way now.
  void find_blocker() const {
    std::map<PartId, std::size_t> count;
    for (const Touch& touch : touches_) ++count[touch.part];
    std::size_t most = 0;
    for (const auto& [part, n] : count) {
      if (n <= most) continue;
      most = n;
      result_.blocked_by = names_[part.index];
      const auto last =
          std::find_if(touches_.rbegin(), touches_.rend(), [p = part](const Touch& t) { return t.part == p; });
      result_.place_W = last->place_W;
    }
  }

  std::atomic<bool> end{false};

 private:
  struct Touch {
    double t;
    PartId part;
    Vec3 place_W;
  };

  void note_contacts(const TickView& tick) {
    while (!touches_.empty() && touches_.front().t < tick.t - kLooksBack) touches_.pop_front();
    const TickReport& report = tick.loop.report();
    const Vec3 center = report.proxy.X * tick.loop.center();
    std::map<PartId, std::pair<Vec3, int>> sums;
    for (const Contact& c : tick.loop.constraints()) {
      if (c.age == kOneShotAge || c.gap > report.contact_gap) continue;
      auto& [sum, n] = sums.try_emplace(c.part, Vec3::Zero(), 0).first->second;
      sum += center + c.r;
      ++n;
    }
    for (const auto& [part, one] : sums) touches_.push_back({tick.t, part, one.first / one.second});
  }

  RouteHand& hand_;
  const RunGoal& goal_;
  const std::atomic<bool>& stop_;
  Result& result_;
  std::vector<std::string> names_;  // of the parts
  std::deque<Touch> touches_;
  double since_ = -1;  // when the part came to its goal, s
};

/// The route with its first leg's aim put astray.
Route astray(Route route, double radius, std::mt19937_64& rng, Result& result) {
  std::normal_distribution<double> normal;
  InsertionTask& leg = route.legs.front();
  const Vec3 e1 = leg.inward.unitOrthogonal(), e2 = leg.inward.cross(e1);
  const auto across = [&](double size) -> Vec3 {
    const double a = normal(rng), b = normal(rng);
    return size * (a * e1 + b * e2);
  };
  leg.offset = across((route.pulls ? kPullOffset : kOffset) * std::min(1.0, radius / kOffsetRadius));
  leg.tilt = across(route.pulls ? kPullTilt : kTilt);
  result.offset = leg.offset.norm();
  result.tilt = leg.tilt.norm();
  return route;
}

}  // namespace

Task make_task(SceneFile file, const Pose& goal, std::uint64_t seed, double seconds) {
  const Vec3 center = HapticLoop(file.scene).center();  // tells what is wrong with the scene, too
  std::vector<Route> routes = find_routes(file.scene, goal, center);
  file.script = StylusScript({{0, held_part(file.scene).pose}, {1, goal}});
  file.scene.scale = 1;
  return {std::move(file), center, std::move(routes), seed, seconds};
}

std::optional<Result> run_try(const Task& task, int number, const std::atomic<bool>& stop, const std::string& record) {
  const auto n = static_cast<std::size_t>(number);
  const auto& people = operator_profiles();
  const OperatorProfile& who = people[(n / task.routes.size()) % people.size()];
  std::seed_seq seeds{static_cast<std::uint32_t>(task.seed), static_cast<std::uint32_t>(task.seed >> 32),
                      static_cast<std::uint32_t>(number)};
  std::mt19937_64 rng(seeds);
  Result result;
  result.number = number;
  result.who = who.name;

  SceneFile file = task.file;
  const double radius = radius_about(*held_part(file.scene).mesh, task.center);
  const Route route = astray(task.routes[n % task.routes.size()], radius, rng, result);
  result.route = route.name;
  RouteHand hand(who, route, task.center, rng);
  file.device.hand = who.hand;
  const RunGoal goal(file, task.center);
  Watcher watcher(file.scene, hand, goal, stop, result);
  RunSettings settings;
  settings.real_time = false;
  settings.seconds = task.seconds;
  settings.hand = &hand;
  settings.observer = &watcher;
  settings.stop = &watcher.end;
  settings.check_all = true;  // the same result on any machine
  settings.stop_check = &stop;
  settings.record = record;
  settings.program = "tegotae " TEGOTAE_VERSION_STRING;
  const RunSummary summary = run_session(file, settings);
  if (!summary.record_failure.empty()) throw Error(summary.record_failure);
  if (stop && !result.reached) return std::nullopt;
  result.depth = summary.depth_m;
  result.force = summary.force_max_n;
  result.torque = summary.torque_max_nm;
  result.intersecting = summary.penetrating;
  if (!result.reached) watcher.find_blocker();
  return result;
}

}  // namespace tegotae::tries
