#include "plan/planner.hpp"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numeric>
#include <random>
#include <utility>

#include "loop/scene_parts.hpp"
#include "plan/exit.hpp"
#include "plan/motion_world.hpp"
#include "plan/search.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/loop/clash.hpp"

namespace tegotae {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kTellEvery = std::chrono::milliseconds(100);
// Of the clearance that start and goal have: a path that was found is shortened with the first one asked for.
constexpr double kShortenShare = 0.9;
// A path with so much of it is searched for, the first that is found is taken; each time with at most as many motions
// that the contact loop is led through as for the first path, and some more.
constexpr double kWiderShares[] = {0.5, 0.1};
constexpr std::int64_t kWiderMore = 30;
// Motions that are asked about to shorten a path, and for each of its poses.
constexpr std::int64_t kShortenChecks = 200, kShortenTimes = 2;
// How often the proof of a motion of the path is taken up again.
constexpr int kProofs = 16;
// A wider path is worth it when it leaves so many times as much.
constexpr double kWorthwhile = 1.5;
// Clearances are told to this share of them.
constexpr double kClearanceStep = 0.02;

/// Processor time of this process, s: hierarchies are built by several threads.
double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

class Planning {
 public:
  Planning(const Scene& scene, const PlanOptions& options)
      : options_(options),
        cpu_began_(processor_seconds()),
        began_(Clock::now()),
        world_(scene, std::max(options.clearance, kGapFloor)),
        exit_(world_.scene(), world_.center(), world_.radius()) {}

  Plan plan() {
    const SearchTask task = make_task();
    SearchResult result = straight_way(task);
    if (!result.found) result = search(world_, task);
    Plan plan;
    plan.search_cpu = processor_seconds() - cpu_began_;
    plan.found = result.found;
    plan.path = result.path;
    fill(result, plan);
    if (plan.found) improve(task, plan);
    tell({"certifying", result.iterations, result.poses, result.way});
    if (plan.clearance == 0) plan.clearance = certified(world_, plan.path);
    plan.found = plan.found && plan.clearance > 0;  // what is not proved is not found
    count(world_, plan);
    plan.interrupted = stopped();
    plan.seconds = seconds();
    plan.cpu = processor_seconds() - cpu_began_;
    return plan;
  }

 private:
  bool stopped() const { return options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed); }
  double seconds() const { return std::chrono::duration<double>(Clock::now() - began_).count(); }
  bool ended() const { return stopped() || (options_.search_ends && options_.search_ends()); }

  void tell(const PlanProgress& progress) {
    if (!options_.progress || Clock::now() < next_tell_) return;
    options_.progress(progress);
    next_tell_ = Clock::now() + kTellEvery;
  }

  std::string name(const std::optional<std::size_t>& part) const {
    return part ? '"' + world_.scene().parts[*part].name + '"' : "another part";
  }

  /// The straight ways alone, which most parts take, before anything is made that they do not need.
  SearchResult straight_way(const SearchTask& task) {
    SearchResult result;
    if (world_.is_complete() || task.exit == nullptr) return result;
    for (const Pose& goal : task.goals) {
      if (ended() || result.iterations >= task.iterations) break;
      ++result.iterations;
      if (!world_.is_free(task.start, goal)) continue;
      result.found = true;
      result.path = {task.start, goal};
      result.poses = result.path.size();
      result.way = displacement(task.start, goal, world_.center()).dp.norm();
      break;
    }
    return result;
  }

  /// Whether the part can stand there, by all that is known.
  bool stands(const Pose& X) {
    if (world_.free_share(X, X) == 1) return true;
    if (world_.is_complete()) return false;
    world_.complete();
    return world_.free_share(X, X) == 1;
  }

  static void include(WorldBox& room, const Vec3& p) {
    room.low = room.low.cwiseMin(p);
    room.high = room.high.cwiseMax(p);
  }

  /// Throws unless the part can stand there.
  Pose checked_goal(Pose goal) {
    goal.q.normalize();
    Scene there = world_.scene();
    held_part(there).pose = goal;
    ClashOptions look;
    look.held_only = true;
    look.tolerance = 0;
    for (const Clash& c : find_clashes(there, look))
      if (c.kind == ClashKind::overlap || c.gap <= 0)
        throw Error("at the goal the held part is in " + name(there.parts[c.a].held ? c.b : c.a));
    if (!stands(goal))
      throw Error("at the goal the held part is nearer to " + name(world_.blocker()) +
                  " than the clearance that the path is to leave");
    return goal;
  }

  SearchTask make_task() {
    const Pose& start = world_.start();
    if (!stands(start))
      throw Error("the held part starts nearer to " + name(world_.blocker()) +
                  " than the clearance that the path is to leave");
    SearchTask task;
    task.start = start;
    task.room = exit_.room();
    if (options_.goal) {
      task.goals = {checked_goal(*options_.goal)};
      include(task.room, *options_.goal * world_.center());
    } else {
      task.goals = exit_.straight_out(start);
      task.exit = &exit_;
    }
    task.seed = options_.seed;
    task.iterations = options_.iterations;
    task.ended = [this] { return ended(); };
    task.progress = [this](std::int64_t iterations, std::size_t poses, double way) {
      tell({"searching", iterations, poses, way});
    };
    return task;
  }

  static bool leaves(MotionWorld& world, const std::vector<Pose>& path, double clearance) {
    for (std::size_t i = 0; i + 1 < path.size(); ++i)
      if (world.free_share(path[i], path[i + 1], clearance, kProofs) < 1) return false;
    return path.size() > 1 || world.free_share(path.front(), path.front(), clearance) == 1;
  }

  /// The most that a path is proved to leave, to a hundredth or two; 0: not even what is asked for. In no order of
  /// their own, few of its motions turn out to leave less than all before.
  static double certified(MotionWorld& world, const std::vector<Pose>& path) {
    std::vector<std::size_t> order(std::max<std::size_t>(1, path.size() - 1));
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), std::mt19937(1));
    double all = world.radius();
    bool first = true;
    for (const std::size_t i : order) {
      const Pose &from = path[i], &to = path[std::min(i + 1, path.size() - 1)];
      const auto leaves = [&](double clearance) { return world.free_share(from, to, clearance, kProofs) == 1; };
      if (!std::exchange(first, false) && leaves(all)) continue;
      if (!leaves(world.clearance())) return 0;
      // From below: what is far beyond the truth takes the certificate long to refuse.
      double low = world.clearance(), high = 2 * low;
      while (high < all && leaves(high)) {
        low = high;
        high *= 2;
      }
      high = std::min(high, all);
      while (high > (1 + kClearanceStep) * low) {
        const double middle = std::sqrt(low * high);
        (leaves(middle) ? low : high) = middle;
      }
      all = low;
    }
    return all;
  }

  /// Shortens a path by motions that leave `clearance`; whether the whole path then does. Whatever a library makes of
  /// it: what is handed out is certified here, or is what the search proved.
  bool shorten_path(MotionWorld& world, const WorldBox& room, double clearance, std::vector<Pose>& path) {
    tell({"shortening", 0, path.size(), 0});
    const std::int64_t most =
        world.counts().checked + kShortenChecks + kShortenTimes * static_cast<std::int64_t>(path.size());
    std::vector<Pose> shorter = shorten(world, path, room, clearance, options_.seed,
                                        [this, &world, most] { return stopped() || world.counts().checked > most; });
    if (!leaves(world, shorter, clearance)) return false;
    path = std::move(shorter);
    return true;
  }

  /// Shortens the path of a plan, and looks for one that leaves more; sets its clearance where that became known.
  void improve(const SearchTask& task, Plan& plan) {
    const std::int64_t led = world_.counts().complied;
    const double most = std::min(certified(world_, {plan.path.front()}), certified(world_, {plan.path.back()}));
    if (kShortenShare * most > world_.clearance() && shorten_path(world_, task.room, kShortenShare * most, plan.path))
      return;
    world_.complete();
    shorten_path(world_, task.room, world_.clearance(), plan.path);
    const double now = plan.clearance = certified(world_, plan.path);
    for (const double share : kWiderShares) {
      const double clearance = share * most;
      // Of parts that hardly leave more than what is asked for there is no wider way to look for.
      if (stopped() || clearance < kWorthwhile * std::max(now, world_.clearance())) return;
      MotionWorld wider(world_.scene(), clearance);
      SearchTask again = task;
      again.ended = [this, &wider, most_led = led + kWiderMore] {
        return stopped() || wider.counts().complied > most_led;
      };
      SearchResult result = search(wider, again);
      const bool taken = result.found && shorten_path(wider, task.room, clearance, result.path);
      count(wider, plan);
      if (!taken) continue;
      plan.path = std::move(result.path);
      plan.clearance = 0;  // of this one not known yet
      return;
    }
  }

  static void count(const MotionWorld& world, Plan& plan) {
    plan.motions += world.counts().checked;
    plan.complied += world.counts().complied;
  }

  void fill(const SearchResult& result, Plan& plan) const {
    plan.center = world_.center();
    plan.start = world_.start_report();
    plan.way = result.way;
    plan.turn = result.turn;
    for (const auto& [part, stops] : result.stops) plan.in_the_way.push_back({part, stops});
    std::stable_sort(plan.in_the_way.begin(), plan.in_the_way.end(),
                     [](const PartInTheWay& a, const PartInTheWay& b) { return a.stops > b.stops; });
    plan.iterations = result.iterations;
    plan.poses = result.poses;
  }

  PlanOptions options_;
  double cpu_began_;  // s
  Clock::time_point began_, next_tell_{};
  MotionWorld world_;
  Exit exit_;
};

}  // namespace

Plan plan_path(const Scene& scene, const PlanOptions& options) {
  if (!has_planner()) throw Error(missing_planner());
  return Planning(scene, options).plan();
}

}  // namespace tegotae
