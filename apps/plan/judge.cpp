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

/// Runs of both planners on a scene.
class Contest {
 public:
  Contest(const Scene& scene, const JudgeOptions& options, const std::function<void(int, const char*)>& progress)
      : scene_(scene),
        seconds_(options.seconds),
        progress_(progress),
        mass_(mass_properties(*held_part(scene).mesh, report(*held_part(scene).mesh).closed)),
        fcl_(scene, mass_.center) {}

  void run_ours(int seed, PlannerFigures& out) {
    progress_(seed, "planning");
    const double end = processor_seconds() + seconds_;
    PlanOptions options;
    options.seed = static_cast<std::uint64_t>(seed);
    options.iterations = std::numeric_limits<std::int64_t>::max();
    options.search_ends = [end] { return processor_seconds() > end; };
    const Plan plan = plan_path(scene_, options);
    if (!plan.found) return;
    ++out.found;
    out.cpu.push_back(plan.search_cpu);
    out.whole_cpu.push_back(plan.cpu);
    out.clearance = out.found == 1 ? plan.clearance : std::min(out.clearance, plan.clearance);
    look_at(seed, plan.path, out);
  }

  void run_baseline(int seed, PlannerFigures& out) {
    progress_(seed, "RRT-Connect with FCL");
    const double begin = processor_seconds();
    const Exit exit(scene_, mass_.center, radius_about(*held_part(scene_).mesh, mass_.center));
    BaselineTask task;
    task.center = mass_.center;
    task.gyration = radius_of_gyration(mass_);
    task.goals = exit.straight_out(held_part(scene_).pose);
    task.room = exit.room();
    task.seed = static_cast<std::uint64_t>(seed);
    task.ended = [end = begin + seconds_] { return processor_seconds() > end; };
    const BaselineResult result = rrt_connect(scene_, task);
    if (!result.found) return;
    ++out.found;
    out.cpu.push_back(processor_seconds() - begin);
    look_at(seed, result.path, out);
  }

 private:
  void look_at(int seed, const std::vector<Pose>& path, PlannerFigures& out) {
    progress_(seed, "asking FCL about the path");
    const PathVerdict verdict = fcl_.ask(path);
    out.checked += verdict.poses;
    out.intersecting += verdict.intersecting;
    out.bad_paths += verdict.intersecting > 0 ? 1 : 0;
  }

  const Scene& scene_;
  double seconds_;
  const std::function<void(int, const char*)>& progress_;
  MassProperties mass_;  ///< of the held part
  PathJudge fcl_;
};

}  // namespace

JudgedFigures judge(const JudgedScene& judged, const JudgeOptions& options,
                    const std::function<void(int seed, const char* what)>& progress) {
  Contest contest(judged.scene, options, progress);
  JudgedFigures out;
  for (int seed = 1; seed <= options.seeds; ++seed) {
    contest.run_ours(seed, out.ours);
    contest.run_baseline(seed, out.baseline);
  }
  return out;
}

}  // namespace tegotae::plan
