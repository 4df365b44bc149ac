#include "tries/try_command.hpp"

#include <iostream>
#include <mutex>
#include <vector>

#include "core/parallel_for.hpp"
#include "core/same_file.hpp"
#include "shared/format.hpp"
#include "shared/pose_option.hpp"
#include "shared/run_options.hpp"
#include "shared/status_line.hpp"
#include "tegotae/core/error.hpp"
#include "tries/try_report.hpp"
#include "tries/try_table.hpp"

namespace tegotae::tries {
namespace {

Task load_task(const TryOptions& o) {
  SceneOptions how;
  how.hold = o.hold;
  SceneFile file = apps::load_with_progress(o.scene, how);
  apps::print_notes(file.scene);
  if (o.goal.empty() && !(file.script.end() > file.script.begin()))
    throw Error(o.scene + ": its script goes nowhere; tell where the part is to go with --goal");
  const Pose goal = o.goal.empty() ? file.script.pose(file.script.end()) : apps::parse_pose(o.goal, file.scene);
  return make_task(std::move(file), goal, o.seed, o.seconds);
}

/// Runs what is missing in the table; ends early when interrupted.
void run_missing(const Task& task, const TryOptions& o, TryTable& table, const std::atomic<bool>& interrupted) {
  std::vector<int> missing;
  for (int i = 0; i < o.tries; ++i)
    if (!table.has(i)) missing.push_back(i);
  apps::StatusLine status;
  std::mutex mutex;
  const auto tell = [&] {
    int reached = 0;
    for (const auto& [number, r] : table.rows()) reached += r.reached ? 1 : 0;
    status.say(apps::format("tries: %zu of %d, %d reached the goal", table.rows().size(), o.tries, reached));
  };
  tell();
  parallel_for(
      static_cast<int>(missing.size()), o.jobs,
      [&](int i) {
        if (interrupted) return;
        const std::optional<Result> result = run_try(task, missing[static_cast<std::size_t>(i)], interrupted);
        if (!result) return;
        const std::lock_guard<std::mutex> lock(mutex);
        table.add(*result);
        tell();
      },
      [](int) {});
}

}  // namespace

CLI::App* add_try(CLI::App& app, TryOptions& o) {
  CLI::App* tries = app.add_subcommand("try", "Let modeled operators try to bring the held part to a goal");
  tries->add_option("SCENE", o.scene, "Scene file (TOML)")->required();
  apps::add_pose_option(*tries, "--goal", o.goal, "Where the part is to go (where the scene's script ends)");
  tries->add_option("--hold", o.hold, "Name of the part to hold, overrides the scene's")->type_name("NAME");
  tries->add_option("--tries", o.tries, "How many")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str()
      ->type_name("N");
  tries->add_option("--jobs", o.jobs, "At the same time (default: all processors); no result depends on it")
      ->check(CLI::Range(1, 1024))
      ->type_name("J");
  tries->add_option("--seed", o.seed, "Of all that is random")->capture_default_str()->type_name("N");
  tries->add_option("--seconds", o.seconds, "That an operator has")
      ->check(CLI::Range(1.0, 3600.0))
      ->capture_default_str()
      ->type_name("S");
  tries->add_option("--out", o.out, "Folder for what it writes; tries that are there are not made again")
      ->capture_default_str()
      ->type_name("DIR");
  return tries;
}

int run_tries(const TryOptions& o) {
  const Task task = load_task(o);
  std::vector<std::string> outputs;
  for (const char* name : {"/tries.csv", "/summary.json", "/report.html", "/best.csv", "/best.csv.info.json"})
    outputs.push_back(o.out + name);
  refuse_to_replace(outputs, task.file.files);
  TryTable table(o.out, fingerprint(task));
  const std::atomic<bool>& interrupted = apps::catch_interrupts();
  run_missing(task, o, table, interrupted);
  std::vector<Result> results;
  for (const auto& [number, r] : table.rows())
    if (number < o.tries) results.push_back(r);
  write_report(task, results, o.out);
  std::cout << summary_text(results);
  const std::string recording = o.out + "/best.csv";
  const Result* best = best_try(results);
  if (interrupted || !run_try(task, best->number, interrupted, recording)) {
    std::cout << "interrupted; the same command goes on from here" << std::endl;
    return apps::kRunFailed;
  }
  std::cout << apps::format("best: try %d, %.2f s, recorded in ", best->number, best->time) << recording << "\n"
            << "report: " << o.out << "/report.html" << std::endl;
  return best->reached ? apps::kDone : apps::kRunFailed;
}

}  // namespace tegotae::tries
