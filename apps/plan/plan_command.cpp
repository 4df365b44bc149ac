#include "plan/plan_command.hpp"

#include <chrono>
#include <iostream>
#include <limits>

#include "core/output_file.hpp"
#include "core/same_file.hpp"
#include "plan/disassembly.hpp"
#include "plan/order_output.hpp"
#include "plan/plan_output.hpp"
#include "plan/planner.hpp"
#include "review/review_command.hpp"
#include "shared/format.hpp"
#include "shared/length_option.hpp"
#include "shared/option_check.hpp"
#include "shared/pose_option.hpp"
#include "shared/run_options.hpp"
#include "shared/status_line.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::plan {
namespace {

constexpr std::int64_t kIterations = 20000;  // default of a plan without a time limit
constexpr double kSeconds = 60;              // default of a plan with one

PlanOptions plan_options(const PlanCommand& o, const Scene& scene, apps::StatusLine& status) {
  PlanOptions options;
  if (!o.goal.empty()) options.goal = apps::parse_pose(o.goal, scene);
  options.clearance = o.clearance;
  options.seed = o.seed.value_or(1);
  // A seed or a number of iterations asks for a repeatable plan: no time limit ends it.
  const bool counted = o.seed || o.iterations;
  options.iterations =
      o.iterations.value_or(counted && !o.seconds ? kIterations : std::numeric_limits<std::int64_t>::max());
  if (o.seconds || !counted) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(o.seconds.value_or(kSeconds));
    options.ends = [end] { return std::chrono::steady_clock::now() > end; };
  }
  options.stop = &apps::catch_interrupts();
  options.progress = [&status](const PlanProgress& p) {
    status.say(apps::format("%s: %lld iterations, %zu poses, %.1f mm from the start", p.what,
                            static_cast<long long>(p.iterations), p.poses, 1e3 * p.way));
  };
  return options;
}

/// `--all`.
int run_all(const PlanCommand& o) {
  SceneOptions how;
  how.held_needed = false;
  how.load = o.load;
  const SceneFile file = apps::load_with_progress(o.scene, how);
  apps::print_notes(file.scene);
  refuse_to_replace(order_files(o.folder, file.scene.parts.size()), file.files);
  make_folder(o.folder);
  DisassemblyOptions options;
  options.clearance = o.clearance;
  options.seed = o.seed.value_or(1);
  options.iterations = o.iterations.value_or(options.iterations);
  options.stop = &apps::catch_interrupts();
  Disassembly order;
  {
    apps::StatusLine status;
    options.progress = [&](const std::vector<std::size_t>& parts, std::size_t left) {
      status.say(apps::format("%zu parts left, trying ", left) + file.scene.parts[parts.front()].name);
    };
    status.say("building hierarchies");
    order = take_apart(file.scene, options);
    write_order(file, order, o.band, o.folder,
                [&](const char* what, std::size_t done, std::size_t total) { status.show(what, done, total); });
  }
  std::cout << order_text(file.scene, order) << "order: " << o.folder << "/order.html" << std::endl;
  return order.left.size() == 1 && order.together.empty() && !order.interrupted ? apps::kDone : apps::kRunFailed;
}

}  // namespace

CLI::App* add_plan(CLI::App& app, PlanCommand& o) {
  CLI::App* plan = app.add_subcommand("plan", "Find a path that brings the held part out, or to a goal");
  plan->add_option("SCENE", o.scene, "Scene file (TOML)")->required();
  CLI::Option* hold =
      plan->add_option("--hold", o.hold, "Name of the part to hold, overrides the scene's")->type_name("NAME");
  CLI::Option* goal = apps::add_pose_option(*plan, "--goal", o.goal, "Goal of the part");
  plan->add_flag("--out", o.out, "Out of all other parts (the default without --goal)")->excludes(goal);
  CLI::Option* all = plan->add_flag("--all", o.all, "Take the whole assembly apart, whatever part is held");
  apps::add_length_option(*plan, "--clearance", o.clearance, "Clearance that the path keeps at least");
  review::add_band_option(*plan, o.band);
  plan->add_option("--seed", o.seed, "Seed of all random choices; the same seed gives the same path")
      ->check(apps::at_least(std::int64_t{0}))
      ->type_name("N");
  plan->add_option("--iterations", o.iterations, "Most iterations of the search")
      ->check(apps::between(std::int64_t{1}, std::int64_t{1000000000}))
      ->type_name("N");
  CLI::Option* seconds =
      plan->add_option("--seconds", o.seconds, "Time that the plan has (60; unbounded with --seed or --iterations)")
          ->check(apps::between(0.1, 1e6))
          ->type_name("S");
  plan->add_option("--to", o.folder, "Folder for the results")->capture_default_str()->type_name("DIR");
  CLI::Option* json = plan->add_flag("--json", o.json, "Print the result as one line of JSON");
  for (CLI::Option* one : {goal, hold, seconds, json}) all->excludes(one);
  return plan;
}

int run_plan(const PlanCommand& o) {
  if (!has_planner()) throw Error(missing_planner());
  if (o.all) return run_all(o);
  SceneOptions how;
  how.hold = o.hold;
  how.load = o.load;
  PlanReport r(apps::load_with_progress(o.scene, how));
  r.to_goal = !o.goal.empty();
  apps::print_notes(r.file.scene);
  refuse_to_replace(plan_files(o.folder), r.file.files);
  make_folder(o.folder);
  {
    apps::StatusLine status;
    status.say("building hierarchies");
    r.plan = plan_path(r.file.scene, plan_options(o, r.file.scene, status));
    const review::Progress progress = [&](const char* what, std::size_t done, std::size_t total) {
      status.show(what, done, total);
    };
    measure(r, o.band, progress);
    write_plan(r, o.folder, progress);
  }
  if (o.json)
    std::cout << plan_json(r) << std::endl;
  else
    std::cout << plan_text(r, o.folder) << std::flush;
  return r.plan.found && !r.plan.interrupted ? apps::kDone : apps::kRunFailed;
}

}  // namespace tegotae::plan
