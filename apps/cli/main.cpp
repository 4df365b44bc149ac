// tegotae: runs scenes, imports assemblies, looks at part files, measures itself.
#include <string>
#include <vector>

#include "bench/bench.hpp"
#include "bench/scenes.hpp"
#include "cli/check.hpp"
#include "cli/dropped_file.hpp"
#include "cli/import.hpp"
#include "cli/run_command.hpp"
#include "cli/view_command.hpp"
#include "experiments/experiments.hpp"
#include "plan/plan_command.hpp"
#include "review/review_command.hpp"
#include "review/script_report.hpp"
#include "shared/guarded_main.hpp"
#include "shared/length_option.hpp"
#include "shared/option_check.hpp"
#include "shared/status_line.hpp"
#include "study/study_command.hpp"
#include "study/try_command.hpp"
#include "tegotae/import/isolated_load.hpp"
#include "tegotae/narrowphase/hierarchy_cache.hpp"

using namespace tegotae;
using namespace tegotae::apps;

namespace {

/// All of them can take long, and one that has commands of its own may run without them too.
void add_progress(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) {
    add_progress_option(*command);
    add_progress(*command);
  }
}

CLI::App* add_check(CLI::App& app, CheckOptions& options) {
  CLI::App* check = app.add_subcommand("check", "Report on mesh files, or on a whole scene (.toml)");
  check->add_option("FILE", options.files, "Mesh files (STL, OBJ, PLY, OFF, glTF, 3MF) and scene files")->required();
  check->add_flag("--clash", options.clash, "List the pairs of a scene's parts that touch or overlap");
  add_length_option(*check, "--within", options.within, "With --clash: also those apart by up to this")
      ->needs("--clash");
  return check;
}

CLI::App* add_bench(CLI::App& app, bench::BenchOptions& options) {
  CLI::App* measure = app.add_subcommand("bench", "Measure the contact loop, FCL beside it, and the linear program");
  std::vector<std::string> names = bench::scene_names();
  names.emplace_back(bench::kStart);
  measure->add_option("--scene", options.scenes, "Only this scene, or the start (may be repeated)")
      ->check(one_of(names))
      ->type_name("NAME");
  measure->add_flag("--quick", options.quick, "A short look: one round of the pen, small programs");
  measure->add_option("--friction", options.mu, "Also with this coefficient of friction between the parts")
      ->check(between(0.0, 10.0));
  measure->add_flag("--budgets", options.budgets, "Also with tick budgets of 0.1 and 0.3 ms");
  measure->add_option("--resolver", options.resolver, "Contact resolver (default: the library's)")->type_name("NAME");
  measure->add_flag("--json", options.json, "Print the figures as one line of JSON");
  measure->add_option("--markdown", options.markdown, "Also replace the generated part of this file")
      ->type_name("FILE");
  return measure;
}

CLI::App* add_experiment(CLI::App& app, experiments::Options& options) {
  CLI::App* experiment =
      app.add_subcommand("experiment", "Run an experiment of the paper; writes CSV files, summary.json and a report");
  experiment->add_option("NAME", options.name, "Which one, or all")->required()->check(one_of(experiments::names()));
  experiment->add_option("--out", options.out, "Folder for the results")->capture_default_str()->type_name("DIR");
  experiment->add_option("--seeds", options.seeds, "Runs of each kind (each experiment has its own number)")
      ->check(between(1, 10000))
      ->type_name("N");
  experiment->add_option("--threads", options.threads, "Threads (default: all processors); no result depends on it")
      ->check(between(1, 1024))
      ->type_name("N");
  experiment->add_flag("--quick", options.quick, "A short form: fewer cases and seeds");
  return experiment;
}

/// All commands with their options.
struct Commands {
  explicit Commands(CLI::App& app)
      : run(add_run(app, run_options)),
        replay(add_replay(app, replay_options)),
        view(add_view(app, view_options)),
        check(add_check(app, check_options)),
        import(add_import(app, import_options)),
        review(review::add_review(app, review_options)),
        tries(study::add_try(app, try_options)),
        study(study::add_study(app, study_options)),
        plan(plan::add_plan(app, plan_options)) {
    for (CLI::App* reads : {run, view, check, replay, review, tries, study, study_options.run, study_options.merge,
                            study_options.one, plan})
      reads->add_flag("--trusted", trusted, "Load meshes in this process, not in one bounded in time and memory");
    measure = add_bench(app, bench_options);
    experiment = add_experiment(app, trials);
  }

  /// Runs the command that was given.
  int execute() {
    set_hierarchy_cache(default_cache_folder());
    const MeshLoader load = [in_process = trusted](const std::string& mesh, double unit) {
      return in_process ? load_mesh(mesh, unit) : load_mesh_isolated(mesh, unit);
    };
    check_options.load = replay_options.load = review_options.load = load;
    try_options.load = study_options.load = plan_options.load = load;
    study_options.trusted = trusted;
    run_options.run.review = view_options.run.review = review::script_report;
    if (check->parsed()) return check_files(check_options);
    if (view->parsed()) return view_file(view_options, load);
    if (measure->parsed()) return bench::run_bench(bench_options);
    if (replay->parsed()) return show_recording(replay_options);
    if (experiment->parsed()) return experiments::run(trials);
    if (review->parsed()) return review::run_review(review_options);
    if (tries->parsed()) return study::run_tries(try_options);
    if (study->parsed()) return study::run_study(study_options);
    if (plan->parsed()) return plan::run_plan(plan_options);
    if (import->parsed()) return import_file(import_options);
    return run_scene(run_options, load);
  }

  RunCommand run_options;
  ReplayOptions replay_options;
  ViewOptions view_options;
  CheckOptions check_options;
  ImportOptions import_options;
  review::ReviewOptions review_options;
  study::TryOptions try_options;
  study::StudyOptions study_options;
  plan::PlanCommand plan_options;
  bench::BenchOptions bench_options;
  experiments::Options trials;
  bool trusted = false;
  CLI::App *run, *replay, *view, *check, *import, *review, *tries, *study, *plan, *measure, *experiment;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Haptic rendering of rigid parts that never pass through each other.", "tegotae");
  app.require_subcommand(1);
  Commands commands(app);
  add_progress(app);
  commands.bench_options.command = "tegotae";
  for (int i = 1; i < argc; ++i) commands.bench_options.command += std::string(" ") + argv[i];

  app.footer("tegotae FILE is tegotae view FILE.");
  std::vector<char*> words = with_view(app, argc, argv);
  return guarded_main(app, static_cast<int>(words.size()) - 1, words.data(), [&] { return commands.execute(); });
}
