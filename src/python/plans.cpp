// Plans.
#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <chrono>
#include <filesystem>
#include <limits>
#include <mutex>

#include "core/output_file.hpp"
#include "core/same_file.hpp"
#include "plan/plan_output.hpp"
#include "python/arrays.hpp"
#include "python/bindings.hpp"
#include "python/reports.hpp"
#include "python/running.hpp"
#include "python/scenes.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::python {
namespace {

using Clock = std::chrono::steady_clock;

/// The scene that is given: a file by its path, or one in memory.
SceneFile scene_of(nb::handle scene, const std::string& name) {
  if (!nb::isinstance<Scene>(scene) && !nb::isinstance<SceneFile>(scene)) return read_scene_file(scene, name, false);
  SceneFile file = nb::isinstance<SceneFile>(scene)
                       ? nb::cast<SceneFile>(scene)
                       : SceneFile{"", nb::cast<Scene>(scene), {}, StylusScript({{0, Pose()}})};
  if (!name.empty()) hold(file.scene, name);
  return file;
}

/// One plan at a time: other threads of Python wait.
class Turn {
 public:
  explicit Turn(const Ending& ending) : lock_(mutex(), std::defer_lock) {
    while (!lock_.try_lock_for(std::chrono::milliseconds(20)))
      if (ending.is_requested()) ending.watch()("", 0, 0);
  }

 private:
  static std::timed_mutex& mutex() {
    static std::timed_mutex one;
    return one;
  }
  std::unique_lock<std::timed_mutex> lock_;
};

void make(plan::PlanReport& report, PlanOptions options, std::optional<double> seconds, const std::string& folder,
          const Ending& ending) {
  const Turn turn(ending);
  if (seconds) {
    const auto end = Clock::now() + std::chrono::duration<double>(*seconds);
    options.ends = [end] { return Clock::now() > end; };
  }
  options.stop = ending.flag();
  report.plan = plan_path(report.file.scene, options);
  measure(report, {}, ending.watch());
  if (folder.empty()) return;
  make_folder(folder);
  write_plan(report, folder, ending.watch());
}

nb::dict plan_columns(nb::handle scene, const std::string& held, nb::handle goal, double clearance, std::uint64_t seed,
                      std::optional<std::int64_t> iterations, std::optional<double> seconds,
                      const std::optional<std::filesystem::path>& to) {
  if (!has_planner()) throw Error(missing_planner());
  plan::PlanReport report(scene_of(scene, held));
  PlanOptions options;
  if (!goal.is_none()) options.goal = pose_of(goal, "goal");
  report.to_goal = !goal.is_none();
  options.clearance = clearance;
  options.seed = seed;
  options.iterations = iterations.value_or(seconds ? std::numeric_limits<std::int64_t>::max() : options.iterations);
  const std::string folder = to ? to->string() : "";
  if (to) {
    if (report.file.path.empty())
      throw Error(ErrorKind::setting,
                  "plan: what is written to a folder names the scene's file, and this scene has none");
    refuse_to_replace(plan::plan_files(folder), report.file.files);
  }
  Ending ending;
  interruptible([&] { make(report, options, seconds, folder, ending); }, [&ending] { ending.request(); });
  nb::dict out;
  out["summary"] = plan_json(report);
  add_columns(out, report.file.scene, report.rows, report.scan);
  return out;
}

}  // namespace

void bind_plans(nb::module_& m) {
  m.def("plan_columns", &plan_columns, nb::arg("scene"), nb::arg("hold"), nb::arg("goal").none(), nb::arg("clearance"),
        nb::arg("seed"), nb::arg("iterations").none(), nb::arg("seconds").none(), nb::arg("to").none(),
        nb::sig(
            "def plan_columns(scene: str | os.PathLike[str] | SceneFile | Scene, hold: str, goal: "
            "numpy.typing.ArrayLike | None, "
            "clearance: float, seed: int, iterations: int | None, seconds: float | None, to: str | os.PathLike[str] | "
            "None) -> dict[str, typing.Any]"),
        "Returns the columns of tegotae.Plan.");
}

}  // namespace tegotae::python
