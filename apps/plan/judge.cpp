#include "plan/judge.hpp"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "broadphase/bounding_spheres.hpp"
#include "loop/scene_parts.hpp"
#include "plan/baseline.hpp"
#include "plan/exit.hpp"
#include "plan/path_judge.hpp"
#include "plan/planner.hpp"
#include "tegotae/mesh/mass.hpp"
#include "tegotae/mesh/report.hpp"

namespace tegotae::plan {
namespace {

/// Processor time of all threads: nothing else runs in this process while a planner does.
double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void look_at(PathJudge& fcl, const std::vector<Pose>& path, PlannerFigures& out) {
  const PathVerdict verdict = fcl.ask(path);
  out.checked += verdict.poses;
  out.intersecting += verdict.intersecting;
  out.bad_paths += verdict.intersecting > 0 ? 1 : 0;
}

void run_ours(const Scene& scene, std::uint64_t seed, double seconds, PathJudge& fcl, PlannerFigures& out) {
  const double end = processor_seconds() + seconds;
  PlanOptions options;
  options.seed = seed;
  options.iterations = std::numeric_limits<std::int64_t>::max();
  options.search_ends = [end] { return processor_seconds() > end; };
  const Plan plan = plan_path(scene, options);
  if (!plan.found) return;
  ++out.found;
  out.cpu.push_back(plan.search_cpu);
  out.whole_cpu.push_back(plan.cpu);
  out.clearance = out.found == 1 ? plan.clearance : std::min(out.clearance, plan.clearance);
  look_at(fcl, plan.path, out);
}

void run_baseline(const Scene& scene, const MassProperties& mass, std::uint64_t seed, double seconds, PathJudge& fcl,
                  PlannerFigures& out) {
  const double begin = processor_seconds();
  const Exit exit(scene, mass.center, radius_about(*held_part(scene).mesh, mass.center));
  BaselineTask task;
  task.center = mass.center;
  task.gyration = radius_of_gyration(mass);
  task.goals = exit.straight_out(held_part(scene).pose);
  task.room = exit.room();
  task.seed = seed;
  task.ended = [end = begin + seconds] { return processor_seconds() > end; };
  const BaselineResult result = rrt_connect(scene, task);
  if (!result.found) return;
  ++out.found;
  out.cpu.push_back(processor_seconds() - begin);
  look_at(fcl, result.path, out);
}

}  // namespace

JudgedFigures judge(const JudgedScene& judged, const JudgeOptions& options) {
  const Scene& scene = judged.scene;
  const TriangleMesh& held = *held_part(scene).mesh;
  const MassProperties mass = mass_properties(held, report(held).closed);
  PathJudge fcl(scene, mass.center);
  JudgedFigures out;
  for (int seed = 1; seed <= options.seeds; ++seed) {
    run_ours(scene, static_cast<std::uint64_t>(seed), options.seconds, fcl, out.ours);
    run_baseline(scene, mass, static_cast<std::uint64_t>(seed), options.seconds, fcl, out.baseline);
  }
  return out;
}

}  // namespace tegotae::plan
