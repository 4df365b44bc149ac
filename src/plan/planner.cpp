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

constexpr auto kReportEvery = std::chrono::milliseconds(100);
// Of the clearance that start and goal have: a path that was found is shortened with the first one asked for.
constexpr double kShortenShare = 0.9;
// A wider path is searched for: one with so much of it first, then between what is known to be found and what was not
// found, until those are so many times apart, or so many widths were not found. What is found leads to what was not
// found before: that is asked for once more.
constexpr double kWidest = 0.5, kApart = 2;
constexpr std::size_t kFailures = 5;
// How long a search takes is luck, so each width has several, with random numbers of their own. A search ends after so
// many motions that the contact loop was led through, or after as many as for the first path.
constexpr int kWiderSearches = 3;
constexpr std::int64_t kWiderLed = 150;
constexpr std::uint64_t kSeedStride = 1000003;
// Motions that are asked about to shorten a path, and for each of its poses.
constexpr std::int64_t kShortenChecks = 200, kShortenTimes = 2;
// How often the proof of a motion of the path is taken up again.
constexpr int kProofs = 16;
// Clearances are told to this share of them.
constexpr double kClearanceStep = 0.02;

/// Processor time of this process, s: hierarchies are built by several threads.
double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Whether a motion is proved to leave `clearance`, from either end: the poses are the same, and where the one proof
/// gives up the other one may have come by.
bool is_proved(MotionWorld& world, const Pose& from, const Pose& to, double clearance) {
  constexpr double kOverlap = 1e-6;  // of the motion, that both have
  const double there = world.free_share(from, to, clearance, kProofs);
  if (there == 1) return true;
  const double back = world.free_share(to, from, clearance, kProofs);
  return back == 1 || there + back > 1 + kOverlap;
}

bool leaves(MotionWorld& world, const std::vector<Pose>& path, double clearance) {
  for (std::size_t i = 0; i + 1 < path.size(); ++i)
    if (!is_proved(world, path[i], path[i + 1], clearance)) return false;
  return path.size() > 1 || world.free_share(path.front(), path.front(), clearance) == 1;
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
    plan.clearance = certified(plan.path);
    plan.found = plan.found && plan.clearance > 0;  // what is not proved is not found
    count(world_, plan);
    plan.interrupted = interrupted();
    plan.out_of_time = !plan.interrupted && stopped();
    plan.seconds = seconds();
    plan.cpu = processor_seconds() - cpu_began_;
    return plan;
  }

 private:
  bool interrupted() const { return options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed); }
  bool stopped() const { return interrupted() || (options_.ends && options_.ends()); }
  double seconds() const { return std::chrono::duration<double>(Clock::now() - began_).count(); }
  bool ended() const { return stopped() || (options_.search_ends && options_.search_ends()); }

  void report(const char* what) {
    if (!options_.progress || (Clock::now() < next_report_ && reported_ == what)) return;
    progress_.what = what;
    reported_ = what;
    options_.progress(progress_);
    next_report_ = Clock::now() + kReportEvery;
  }

  /// What a search tells of itself.
  std::function<void(std::int64_t, std::size_t, double)> teller(const char* what) {
    return [this, what](std::int64_t iterations, std::size_t poses, double way) {
      progress_ = {what, iterations, poses, way};
      report(what);
    };
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
    ClashOptions options;
    options.held_only = true;
    options.tolerance = 0;
    for (const Clash& c : find_clashes(there, options))
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
    task.progress = teller("searching");
    return task;
  }

  /// The most that a path is proved to leave, to a hundredth or two; 0: not even what is asked for. In no order of
  /// their own, few of its motions turn out to leave less than all before. Once the plan is stopped no more than what
  /// has to be proved is asked about.
  double certified(const std::vector<Pose>& path) {
    if (stopped() && proved_ > 0) return proved_;
    std::vector<std::size_t> order(std::max<std::size_t>(1, path.size() - 1));
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), std::mt19937(1));
    const double least = std::max(proved_, world_.clearance());
    double all = world_.radius();
    bool first = true;
    for (const std::size_t i : order) {
      report("certifying");
      const Pose &from = path[i], &to = path[std::min(i + 1, path.size() - 1)];
      const auto leaves = [&](double clearance) { return world_.free_share(from, to, clearance, kProofs) == 1; };
      if (!std::exchange(first, false) && !stopped() && leaves(all)) continue;
      if (proved_ == 0 && !is_proved(world_, from, to, least)) return 0;
      // From below: what is far beyond the truth takes the certificate long to refuse.
      double low = least, high = 2 * low;
      while (!stopped() && high < all && leaves(high)) {
        low = high;
        high *= 2;
      }
      high = std::min(high, all);
      while (!stopped() && high > (1 + kClearanceStep) * low) {
        const double middle = std::sqrt(low * high);
        (leaves(middle) ? low : high) = middle;
      }
      all = low;
    }
    return proved_ = all;
  }

  /// What the part leaves where it stands.
  double certified(const Pose& X) {
    proved_ = 0;
    return certified(std::vector<Pose>{X});
  }

  /// Shortens a path by motions that leave `clearance`; whether the whole path then does. Whatever a library makes of
  /// it: what is handed out is certified here, or is what the search proved.
  bool shorten_path(MotionWorld& world, const WorldBox& room, double clearance, std::vector<Pose>& path) {
    const std::int64_t most =
        world.counts().checked + kShortenChecks + kShortenTimes * static_cast<std::int64_t>(path.size());
    ShortenTask task;
    task.room = room;
    task.clearance = clearance;
    task.seed = options_.seed;
    task.ended = [this, &world, most] {
      report("shortening");
      return stopped() || world.counts().checked > most;
    };
    task.stopped = [this] { return stopped(); };
    std::vector<Pose> shorter = shorten(world, path, task);
    if (!leaves(world, shorter, clearance)) return false;
    path = std::move(shorter);
    proved_ = clearance;
    return true;
  }

  /// Shortens the path of a plan, and looks for one that leaves more.
  void improve(const SearchTask& task, Plan& plan) {
    if (stopped()) return;
    const std::int64_t led = world_.counts().complied;
    const double most = std::min(certified(plan.path.front()), certified(plan.path.back()));
    proved_ = 0;  // of the path
    if (kShortenShare * most > world_.clearance() && shorten_path(world_, task.room, kShortenShare * most, plan.path))
      return;
    if (stopped()) return;
    world_.complete();
    shorten_path(world_, task.room, world_.clearance(), plan.path);
    widen(task, kWidest * most, std::max(kWiderLed, led), plan);
  }

  /// Looks for a path that leaves more, up to `widest`. Each search leads the part `most_led` times.
  void widen(const SearchTask& task, double widest, std::int64_t most_led, Plan& plan) {
    double low = std::max(certified(plan.path), world_.clearance()), width = widest;
    if (width <= kApart * low) return;
    std::vector<double> failed;  // those that are still to be found, the least last
    for (std::size_t failures = 0; failures < kFailures && !stopped();) {
      if (take_wider(task, width, most_led, plan)) {
        low = width;
        if (failed.empty() || failed.back() <= kApart * low) return;
        width = failed.back();
        failed.pop_back();
      } else {
        ++failures;
        failed.push_back(width);
        if (width <= kApart * low) return;
        width = std::sqrt(low * width);
      }
    }
  }

  /// Whether a path is found that leaves `clearance`; the plan then has it. Each search leads the part `most_led`
  /// times.
  bool take_wider(const SearchTask& task, double clearance, std::int64_t most_led, Plan& plan) {
    MotionWorld wider(world_.scene(), clearance);
    SearchTask again = task;
    again.known = plan.path;
    again.progress = teller("searching for a wider way");
    bool taken = false;
    for (int i = 0; i < kWiderSearches && !taken && !stopped(); ++i) {
      again.seed = task.seed + static_cast<std::uint64_t>(i) * kSeedStride;
      again.ended = [this, &wider, end = wider.counts().complied + most_led] {
        return stopped() || wider.counts().complied > end;
      };
      SearchResult result = search(wider, again);
      taken = result.found &&
              (shorten_path(wider, task.room, clearance, result.path) || leaves(wider, result.path, clearance));
      if (!taken) continue;
      plan.path = std::move(result.path);
      proved_ = clearance;
    }
    count(wider, plan);
    return taken;
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
  Clock::time_point began_, next_report_{};
  PlanProgress progress_{"searching"};
  std::string reported_;  // what it was about last
  double proved_ = 0;     ///< m, that the path as a whole is proved to leave; 0: not known yet
  MotionWorld world_;
  Exit exit_;
};

}  // namespace

Plan plan_path(const Scene& scene, const PlanOptions& options) {
  if (!has_planner()) throw Error(missing_planner());
  return Planning(scene, options).plan();
}

}  // namespace tegotae
