#include "study/try_command.hpp"

#include <iostream>
#include <vector>

#include "core/same_file.hpp"
#include "shared/format.hpp"
#include "shared/option_check.hpp"
#include "shared/pose_option.hpp"
#include "shared/run_options.hpp"
#include "shared/status_line.hpp"
#include "study/outcome.hpp"
#include "study/report.hpp"
#include "study/shard.hpp"

namespace tegotae::study {
namespace {

/// Tries are a study of one scene in which nothing but the operators and routes differs.
Study study_of(const TryOptions& o) {
  Study study;
  study.scenes = {o.scene};
  study.hold = o.hold;
  study.goal = o.goal;
  study.seconds = o.seconds;
  study.seed = o.seed;
  study.repeats = o.tries;
  return study;
}

}  // namespace

CLI::App* add_try(CLI::App& app, TryOptions& o) {
  CLI::App* tries = app.add_subcommand("try", "Let modeled operators try to bring the held part to a goal");
  tries->add_option("SCENE", o.scene, "Scene file (TOML)")->required();
  apps::add_goal_option(*tries, "--goal", o.goal,
                        "Goal of the part, or \"out\": out of all others (default: where the scene's script ends)");
  tries->add_option("--hold", o.hold, "Name of the part to hold, overrides the scene's")->type_name("NAME");
  tries->add_option("--tries", o.tries, "Number of tries")
      ->check(apps::between(1, 100000))
      ->capture_default_str()
      ->type_name("N");
  tries->add_option("--jobs", o.jobs, "Tries at the same time (default: all processors); no result depends on it")
      ->check(apps::between(1, 1024))
      ->type_name("J");
  tries->add_option("--seed", o.seed, "Seed of all random choices")
      ->check(apps::at_least(std::int64_t{0}))
      ->capture_default_str()
      ->type_name("N");
  tries->add_option("--seconds", o.seconds, "Time that an operator has")
      ->check(apps::between(1.0, 3600.0))
      ->capture_default_str()
      ->type_name("S");
  tries->add_option("--out", o.out, "Folder for the results; finished tries in it are not repeated")
      ->capture_default_str()
      ->type_name("DIR");
  return tries;
}

int run_tries(const TryOptions& o) {
  const Study study = study_of(o);
  const std::unique_ptr<Tasks> tasks = load_tasks(study, o.load);
  {
    apps::StatusLine status;
    status.say("preparing the tries");
    tasks->of(make_case(study, 0));  // what is wrong with it, before anything is written
  }
  std::vector<std::string> outputs;
  for (const char* name : {"/tries.csv", "/summary.json", "/report.html", "/best.csv", "/best.csv.info.json"})
    outputs.push_back(o.out + name);
  refuse_to_replace(outputs, tasks->inputs());
  CaseTable table(o.out + "/tries.csv", layout_of(study, *tasks));
  const std::atomic<bool>& interrupted = apps::catch_interrupts();
  run_missing(study, *tasks, numbers_of({}, o.tries), o.jobs, table, interrupted);
  std::vector<Result> results;
  for (const auto& [number, r] : table.rows())
    if (number < o.tries) results.push_back(r);
  write_report(study, *tasks, results, {}, o.out);
  std::cout << summary_text(results, word_for(study));
  const std::string recording = o.out + "/best.csv";
  const Result* best = best_case(results);
  const RecordTo record_to = [&](SceneFile&, std::size_t) { return recording; };
  const auto record_best = [&] {
    apps::StatusLine status;
    status.say("recording the best try");
    return run_case(study, *tasks, make_case(study, best->number), interrupted, record_to).has_value();
  };
  if (interrupted || !record_best()) {
    std::cout << "interrupted; the same command continues from here" << std::endl;
    return apps::kRunFailed;
  }
  std::cout << apps::format("best: try %d, %.2f s, recorded in ", best->number, best->time) << recording << "\n";
  if (!best->reached) std::cout << "FAILED: " << best->why << "\n";
  std::cout << "report: " << o.out << "/report.html" << std::endl;
  return best->reached ? apps::kDone : apps::kRunFailed;
}

}  // namespace tegotae::study
