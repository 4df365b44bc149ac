#include "plan/judge.hpp"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "broadphase/bounding_spheres.hpp"
#include "loop/scene_parts.hpp"
#include "narrowphase/fcl_pairs.hpp"
#include "plan/baseline.hpp"
#include "plan/exit.hpp"
#include "plan/planner.hpp"
#include "tegotae/mesh/mass.hpp"
#include "tegotae/mesh/report.hpp"

namespace tegotae::plan {
namespace {

constexpr double kOracleStep = 20e-6;  // m, of what any point of the held part goes

double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// FCL about a path, every 20 µm; knows nothing of the planners.
class PathOracle {
 public:
  PathOracle(const Scene& scene, const Vec3& center)
      : scene_(scene), held_(held_part(scene)), center_(center), radius_(radius_about(*held_.mesh, center)) {}

  void ask(const std::vector<Pose>& path, PlannerFigures& out) {
    const std::int64_t before = out.intersecting;
    ask(path.front(), out);
    for (std::size_t i = 1; i < path.size(); ++i) {
      const Displacement d = displacement(path[i - 1], path[i], center_);
      const int parts = std::max(1, static_cast<int>(std::ceil((d.dp.norm() + radius_ * d.dr.norm()) / kOracleStep)));
      for (int k = 1; k <= parts; ++k) ask(displaced(path[i - 1], center_, static_cast<double>(k) / parts * d), out);
    }
    out.bad_paths += out.intersecting > before ? 1 : 0;
  }

 private:
  void ask(const Pose& X, PlannerFigures& out) {
    ++out.checked;
    for (const Part& part : scene_.parts)
      if (!part.held && fcl_.intersect(*held_.mesh, *part.mesh, part.pose.inverse() * X)) {
        ++out.intersecting;
        return;
      }
  }

  const Scene& scene_;
  const Part& held_;
  Vec3 center_;
  double radius_;
  FclPairs fcl_;
};

void run_ours(const Scene& scene, std::uint64_t seed, double seconds, PathOracle& oracle, PlannerFigures& out) {
  const double end = thread_seconds() + seconds;
  PlanOptions options;
  options.seed = seed;
  options.iterations = std::numeric_limits<std::int64_t>::max();
  options.search_ends = [end] { return thread_seconds() > end; };
  const Plan plan = plan_path(scene, options);
  if (!plan.found) return;
  ++out.found;
  out.cpu.push_back(plan.search_cpu);
  out.whole_cpu.push_back(plan.cpu);
  out.clearance = out.found == 1 ? plan.clearance : std::min(out.clearance, plan.clearance);
  oracle.ask(plan.path, out);
}

void run_baseline(const Scene& scene, const MassProperties& mass, std::uint64_t seed, double seconds,
                  PathOracle& oracle, PlannerFigures& out) {
  const double begin = thread_seconds();
  const Exit exit(scene, mass.center, radius_about(*held_part(scene).mesh, mass.center));
  BaselineTask task;
  task.center = mass.center;
  task.gyration = radius_of_gyration(mass);
  task.goals = exit.straight_out(held_part(scene).pose);
  task.room = exit.room();
  task.seed = seed;
  task.ended = [end = begin + seconds] { return thread_seconds() > end; };
  const BaselineResult result = rrt_connect(scene, task);
  if (!result.found) return;
  ++out.found;
  out.cpu.push_back(thread_seconds() - begin);
  oracle.ask(result.path, out);
}

}  // namespace

JudgedFigures judge(const JudgedScene& judged, const JudgeOptions& options) {
  const Scene& scene = judged.scene;
  const TriangleMesh& held = *held_part(scene).mesh;
  const MassProperties mass = mass_properties(held, report(held).closed);
  PathOracle oracle(scene, mass.center);
  JudgedFigures out;
  for (int seed = 1; seed <= options.seeds; ++seed) {
    run_ours(scene, static_cast<std::uint64_t>(seed), options.seconds, oracle, out.ours);
    run_baseline(scene, mass, static_cast<std::uint64_t>(seed), options.seconds, oracle, out.baseline);
  }
  return out;
}

}  // namespace tegotae::plan
