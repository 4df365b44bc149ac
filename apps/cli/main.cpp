// tegotae: runs scenes, imports assemblies, looks at part files, measures itself.
#include <cmath>
#include <string>
#include <vector>

#include "bench/bench.hpp"
#include "bench/scenes.hpp"
#include "cli/check.hpp"
#include "cli/import.hpp"
#include "cli/view_command.hpp"
#include "experiments/experiments.hpp"
#include "plan/plan_command.hpp"
#include "review/review_command.hpp"
#include "review/script_report.hpp"
#include "shared/length_option.hpp"
#include "shared/run_options.hpp"
#include "shared/status_line.hpp"
#include "study/study_command.hpp"
#include "study/try_command.hpp"
#include "tegotae/import/isolated_load.hpp"
#include "tegotae/narrowphase/hierarchy_cache.hpp"

using namespace tegotae;
using namespace tegotae::apps;

namespace {
constexpr double kLongestRun = 1e6;  // s: eleven days; far below where ticks or nanoseconds overflow

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Haptic rendering of rigid parts that never pass through each other.", "tegotae");
  app.require_subcommand(1);

  RunOptions options;
  std::string scene;
  CLI::App* run = app.add_subcommand("run", "Run a scene: its pen, servo and contact loop");
  run->add_option("SCENE", scene, "Scene file (TOML)")->required();
  std::string hold;
  run->add_option("--hold", hold, "Name of the part to hold, overrides the scene's")->type_name("NAME");
  std::string script;
  run->add_option("--script", script, "Stylus script (CSV) instead of the scene's")->type_name("FILE");
  add_guide_option(*run, options);
  add_run_options(*run, options);
  run->add_option("--seconds", options.seconds, "How long to run (default: to the end of the script)")
      ->check([](const std::string& text) -> std::string {
        double value = 0;  // CLI::PositiveNumber lets nan pass
        if (CLI::detail::lexical_cast(text, value) && value > 0 && value <= kLongestRun) return "";
        return "must be a positive number, at most a million";
      })
      ->type_name("S");

  std::string recording, recorded_scene, html;
  PageOptions replay_page;
  CLI::App* replay = app.add_subcommand("replay", "Serve a page that shows a recording, until Ctrl-C");
  replay->add_option("RECORDING", recording, "What --record wrote")->required();
  replay->add_option("SCENE", recorded_scene, "Its scene file (the one that the recording names)");
  auto* file =
      replay->add_option("--html", html, "Write the page to a file that needs no server, then exit")->type_name("FILE");
  const PageOptionNames page = add_page_options(*replay, replay_page);
  page.address->excludes(file);
  page.no_browser->excludes(file);

  ViewOptions view_options;
  CLI::App* view = add_view(app, view_options);

  CheckOptions check_options;
  CLI::App* check = app.add_subcommand("check", "Report on mesh files, or on a whole scene (.toml)");
  check->add_option("FILE", check_options.files, "Mesh files (STL, OBJ, PLY, OFF, glTF, 3MF) and scene files")
      ->required();

  check->add_flag("--clash", check_options.clash, "List the pairs of a scene's parts that touch or overlap");
  add_length_option(*check, "--within", check_options.within, "With --clash: also those apart by up to this")
      ->needs("--clash");

  ImportOptions import_options;
  const CLI::App* import = add_import(app, import_options);

  review::ReviewOptions review_options;
  const CLI::App* review = review::add_review(app, review_options);

  study::TryOptions try_options;
  const CLI::App* tries = study::add_try(app, try_options);

  study::StudyOptions study_options;
  const CLI::App* study = study::add_study(app, study_options);

  plan::PlanCommand plan_options;
  const CLI::App* plan = plan::add_plan(app, plan_options);

  bool trusted = false;
  for (CLI::App* reads : {run, view, check})
    reads->add_flag("--trusted", trusted, "Load meshes in this process, not in one bounded in time and memory");

  bench::BenchOptions bench_options;
  CLI::App* measure = app.add_subcommand("bench", "Measure the contact loop, FCL beside it, and the linear program");
  measure->add_option("--scene", bench_options.scenes, "Only this scene (may be repeated)")
      ->check(CLI::IsMember(bench::scene_names()))
      ->type_name("NAME");
  measure->add_flag("--quick", bench_options.quick, "A short look: one round of the pen, small programs");
  measure->add_option("--friction", bench_options.mu, "Also with this coefficient of friction between the parts")
      ->check(CLI::Range(0.0, 10.0));
  measure->add_flag("--budgets", bench_options.budgets, "Also with tick budgets of 0.1 and 0.3 ms");
  measure->add_option("--resolver", bench_options.resolver, "Contact resolver (default: the library's)")
      ->type_name("NAME");
  measure->add_flag("--json", bench_options.json, "Print the figures as one line of JSON");
  measure->add_option("--markdown", bench_options.markdown, "Also replace the generated part of this file")
      ->type_name("FILE");
  bench_options.command = "tegotae";
  for (int i = 1; i < argc; ++i) bench_options.command += std::string(" ") + argv[i];

  experiments::Options trials;
  CLI::App* experiment =
      app.add_subcommand("experiment", "Run an experiment of the paper; writes CSV files, summary.json and a report");
  experiment->add_option("NAME", trials.name, "Which one, or all")
      ->required()
      ->check(CLI::IsMember(experiments::names()));
  experiment->add_option("--out", trials.out, "Folder for what it writes")->capture_default_str()->type_name("DIR");
  experiment->add_option("--seeds", trials.seeds, "Runs of each kind (each experiment has its own number)")
      ->check(CLI::Range(1, 10000))
      ->type_name("N");
  experiment->add_option("--threads", trials.threads, "Threads (default: all processors); no result depends on it")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  experiment->add_flag("--quick", trials.quick, "A short form: fewer cases and seeds");

  return guarded_main(app, argc, argv, [&] {
    set_hierarchy_cache(default_cache_folder());
    const MeshLoader load = [trusted](const std::string& mesh, double unit) {
      return trusted ? load_mesh(mesh, unit) : load_mesh_isolated(mesh, unit);
    };
    check_options.load = load;
    options.review = view_options.run.review = review::script_report;
    if (check->parsed()) return check_files(check_options);
    if (view->parsed()) return view_file(view_options, load);
    if (measure->parsed()) return bench::run_bench(bench_options);
    if (replay->parsed()) return show_recording(recording, recorded_scene, html, replay_page);
    if (experiment->parsed()) return experiments::run(trials);
    if (review->parsed()) return review::run_review(review_options);
    if (tries->parsed()) return study::run_tries(try_options);
    if (study->parsed()) return study::run_study(study_options);
    if (plan->parsed()) return plan::run_plan(plan_options);
    if (import->parsed()) return import_file(import_options);
    const SceneOptions how{hold, true, {}, load};
    SceneFile loaded = options.json ? load_scene(scene, how) : load_with_progress(scene, how);
    print_notes(loaded.scene);
    if (!script.empty()) {
      loaded.script = read_script(script);
      loaded.files.push_back(script);
    }
    return run_and_report(std::move(loaded), options, scene);
  });
}
