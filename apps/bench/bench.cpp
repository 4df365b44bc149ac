#include "bench/bench.hpp"

#include <algorithm>
#include <iostream>
#include <optional>
#include <set>

#include "bench/results.hpp"
#include "narrowphase/patch_tree.hpp"
#include "shared/run_options.hpp"
#include "shared/status_line.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae::bench {
namespace {

// Rounds of the pen: ten thousand ticks and more, so that p99.9 is not one tick alone. The fast pen needs more of them.
constexpr int kRounds = 3, kFastRounds = 12;
constexpr int kJams = 200, kQuickJams = 20;
// Other budgets than the default one, s.
constexpr double kBudgets[] = {0.1e-3, 0.3e-3};

BuildFigures measure_build(const Scene& scene) {
  std::set<const TriangleMesh*> seen;
  double us = 0, bytes = 0, triangles = 0;
  for (const Part& part : scene.parts) {
    if (!seen.insert(part.mesh.get()).second) continue;
    const std::int64_t start = process_cpu_ns();
    const PatchTree tree(part.mesh);
    us += 1e-3 * static_cast<double>(process_cpu_ns() - start);
    bytes += static_cast<double>(tree.bytes());
    triangles += static_cast<double>(part.mesh->triangles.size());
  }
  return {us / triangles, bytes / triangles};
}

BudgetFigures measure_budget(const BenchScene& scene, double budget) {
  Scene other = scene.scene;
  other.contact.tick_budget = budget;
  HapticLoop loop(other);
  LoopTrace trace;
  BudgetFigures f{budget, measure_loop(scene, loop, kHandSpeed, kRounds, trace), trace.checked, 0};
  f.intersecting = trace.committed.count_intersecting(scene.scene);
  return f;
}

FrictionFigures measure_friction(const BenchScene& scene, double mu, int rounds) {
  Scene rubbing = scene.scene;
  rubbing.friction.mu = mu;
  HapticLoop loop(rubbing);
  LoopTrace trace;
  FrictionFigures f{mu, measure_loop(scene, loop, kHandSpeed, rounds, trace), trace.checked, 0};
  f.intersecting = trace.committed.count_intersecting(scene.scene);
  return f;
}

SceneFigures measure_scene(const std::string& name, const BenchOptions& options, apps::StatusLine& progress) {
  const int jams = options.quick ? kQuickJams : kJams;
  progress.say(name + ": building");
  BenchScene scene = make_scene(name, jams);
  if (!options.resolver.empty()) scene.scene.contact.resolver = resolver_kind(options.resolver);
  SceneFigures f;
  f.scene = name;
  f.targets = scene.targets;
  f.depth = scene.depth;
  f.held_triangles = scene.held_triangles;
  f.fixed_triangles = scene.fixed_triangles;
  f.build = measure_build(scene.scene);
  LoopTrace trace;
  Vec3 center;
  {
    HapticLoop loop(scene.scene);
    center = loop.center();
    progress.say(name + ": at hand speed");
    f.hand = measure_loop(scene, loop, kHandSpeed, options.quick ? 1 : kRounds, trace);
    progress.say(name + ": the same without a budget");
    std::optional<HapticLoop> unlimited(without_budget(scene.scene, trace.start));
    f.hand_lag = measure_lag(scene, *unlimited, trace);
    progress.say(name + ": fast");
    f.fast = measure_loop(scene, loop, kFastSpeed, options.quick ? 1 : kFastRounds, trace);
    progress.say(name + ": the same without a budget");
    if (f.hand_lag.ticks < f.hand.ticks) unlimited.emplace(without_budget(scene.scene, trace.start));
    f.fast_lag = measure_lag(scene, *unlimited, trace);
  }
  if (options.mu > 0) {
    progress.say(name + ": friction");
    f.friction = measure_friction(scene, options.mu, options.quick ? 1 : kRounds);
  }
  if (scene.seat) {
    progress.say(name + ": seat");
    HapticLoop loop(scene.scene);
    f.seat = measure_seat(scene, loop, trace);
    f.seat_targets = scene.seat->targets;
  }
  progress.say(name + ": FCL");
  f.fcl = measure_fcl(scene, center, trace, std::min(jams, scene.most_fcl_poses));
  progress.say(name + ": checking");
  f.checked = trace.checked;
  f.intersecting = trace.committed.count_intersecting(scene.scene);
  if (!options.budgets) return f;
  for (const double budget : kBudgets) {
    progress.say(name + ": budgets");
    f.budgets.push_back(measure_budget(scene, budget));
  }
  f.budgets.push_back({scene.scene.contact.tick_budget, f.hand, f.checked, f.intersecting});
  return f;
}

}  // namespace

int run_bench(const BenchOptions& options) {
  const std::int64_t start = monotonic_ns();
  Results results;
  bool free = true;
  {
    apps::StatusLine progress;
    std::vector<std::string> names = options.scenes.empty() ? scene_names() : options.scenes;
    const auto others = std::remove(names.begin(), names.end(), kStart);
    const bool asked = others != names.end();
    names.erase(others, names.end());
    if (options.scenes.empty() || asked) {
      progress.say("start");
      results.starts = measure_starts(options.quick);
    }
    for (const std::string& name : names) {
      results.rows.push_back(measure_scene(name, options, progress));
      const SceneFigures& row = results.rows.back();
      free = free && row.intersecting == 0;
      for (const BudgetFigures& b : row.budgets) free = free && b.intersecting == 0;
      free = free && !(row.friction && row.friction->intersecting > 0);
    }
    progress.say("linear programs");
    results.lp = measure_lp(options.quick);
    if (options.mu > 0) results.friction_solves = measure_friction_solves(options.quick);
  }
  results.seconds = 1e-9 * static_cast<double>(monotonic_ns() - start);
  if (!options.markdown.empty()) update_markdown(options.markdown, options.command, results);
  std::cout << (options.json ? json_line(results) : tables(results)) << std::endl;
  return free ? apps::kDone : apps::kRunFailed;
}

}  // namespace tegotae::bench
