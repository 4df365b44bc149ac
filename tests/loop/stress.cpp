// Random pens over many scenes; every committed piece and poses inside it are asked of FCL. Exit code 0: none
// intersects, no tick hid that it was late, and none was held back without a contact; 1: some; 2: wrong use. See
// `stress --help`.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "shared/guarded_main.hpp"
#include "stress_run.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

void print(const std::string& name, const StressResult& r, const LatencyHistogram& cpu) {
  const LatencySummary us = summary(cpu);
  std::printf(
      "%-16s %5lld scripts %7lld ticks %7lld substeps %8lld poses, intersecting %lld | touching %4.1f%% timed out %lld "
      "overflow %lld infeasible %lld stalled %lld lag time %lld capacity %lld unexplained %lld late unreported %lld | "
      "tick us p50 %.0f p99 %.0f "
      "p99.9 %.0f "
      "max %.0f | loop %.1f s check %.1f s\n",
      name.c_str(), (long long)r.scripts, (long long)r.ticks, (long long)r.substeps, (long long)r.poses,
      (long long)r.intersecting, 100.0 * (double)r.touching / (double)std::max<std::int64_t>(1, r.ticks),
      (long long)r.timed_out, (long long)r.overflow, (long long)r.infeasible, (long long)r.stalled,
      (long long)r.out_of_time, (long long)r.out_of_capacity, (long long)r.unexplained, (long long)r.late_unreported,
      us.p50, us.p99, us.p999, us.max, r.seconds_loop, r.seconds_check);
}

struct StressRun {
  int scripts = 1000;
  unsigned seed = 1;
  std::vector<std::string> scenes;
  std::string resolver = "both";
  double friction = 0;
  StressOptions options;
};

void add_options(CLI::App& app, StressRun& run) {
  app.add_option("--scripts", run.scripts, "How many, over the scenes in turn")->capture_default_str();
  app.add_option("--seed", run.seed, "Of the first script; the next ones count up")->capture_default_str();
  app.add_option("--scene", run.scenes, "Only this scene; can be given several times");
  app.add_option("--resolver", run.resolver, "lp, qp or both in turn")
      ->check(CLI::IsMember({"lp", "qp", "both"}))
      ->capture_default_str();
  app.add_option("--friction", run.friction, "Coefficients from a fifth of this up to this, by script; with qp alone")
      ->check(CLI::Range(0.0, 10.0));
  app.add_option("--ticks", run.options.ticks, "Of a script, 1 ms each")->capture_default_str();
  app.add_option("--between", run.options.between,
                 "Poses asked inside a piece, on the two readings of its path in turn")
      ->capture_default_str();
  app.add_option("--budget", run.options.budget, "Tick budget, s; 0: bounded by work alone")->capture_default_str();
  app.add_option("--record", run.options.record, "Folder for a scene file and a recording of each script");
}

/// Runs script `i` and adds it to the sums of its scene.
StressResult run_script(const StressRun& run, int i,
                        std::map<std::string, std::pair<StressResult, LatencyHistogram>>& results) {
  const int n = static_cast<int>(run.scenes.size()), round = i / n;
  const std::string& name = run.scenes[static_cast<std::size_t>(i % n)];
  const unsigned seed = run.seed + static_cast<unsigned>(i);
  StressOptions options = run.options;
  options.resolver = run.resolver != "both" ? run.resolver : round % 2 == 0 ? "qp" : "lp";
  options.mu = run.friction * (1 + round % 5) / 5;
  auto& [sum, cpu] = results[name];
  StressResult one = run_stress_script(stress_scene(name, seed), seed, options, cpu);
  if (!one.first_intersecting.empty()) std::printf("INTERSECTS: %s\n", one.first_intersecting.c_str());
  if (!one.first_late.empty()) std::printf("LATE: %s\n", one.first_late.c_str());
  if (one.infeasible + one.stalled > 0)
    std::printf("UNSOLVED: %s seed %u resolver %s\n", name.c_str(), seed, options.resolver.c_str());
  if (i % 100 == 99) std::printf("%d scripts\n", i + 1);
  sum.add(one);
  return one;
}

int run_all(StressRun run) {
  if (run.friction > 0) run.resolver = "qp";
  if (run.scenes.empty()) run.scenes = stress_scene_names();
  std::map<std::string, std::pair<StressResult, LatencyHistogram>> results;
  StressResult all;
  for (int i = 0; i < run.scripts; ++i) all.add(run_script(run, i, results));
  for (const auto& [name, result] : results) print(name, result.first, result.second);
  std::printf("%lld scripts, %lld poses checked: %lld intersecting, %lld programs without an answer\n",
              (long long)all.scripts, (long long)all.poses, (long long)all.intersecting,
              (long long)(all.infeasible + all.stalled));
  std::printf("%lld ticks held back for long without a contact\n", (long long)all.unexplained);
  return all.intersecting + all.late_unreported + all.unexplained > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Random pens over many scenes; every committed piece and poses inside it are asked of FCL.", "stress"};
  StressRun run;
  add_options(app, run);
  return apps::guarded_main(app, argc, argv, [&] {
    setlinebuf(stdout);
    return run_all(run);
  });
}
