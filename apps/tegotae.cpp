// tegotae: runs scenes, looks at part files, measures itself.
#include <cmath>
#include <string>
#include <vector>

#include "bench/bench.hpp"
#include "bench/scenes.hpp"
#include "check.hpp"
#include "run_options.hpp"
#include "tegotae/mesh/isolated_load.hpp"

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
  add_run_options(*run, options);
  run->add_option("--seconds", options.seconds, "How long to run (to the end of the script unless told)")
      ->check([](const std::string& text) -> std::string {
        double value = 0;  // CLI::PositiveNumber lets nan pass
        if (CLI::detail::lexical_cast(text, value) && value > 0 && value <= kLongestRun) return "";
        return "must be a positive number, at most a million";
      })
      ->type_name("S");

  std::vector<std::string> files;
  CLI::App* check = app.add_subcommand("check", "Report on mesh files, or on a whole scene (.toml)");
  check->add_option("FILE", files, "Mesh files (STL, OBJ, PLY, OFF, glTF) and scene files")->required();

  bool isolated = false;
  for (CLI::App* reads : {run, check})
    reads->add_flag("--isolated", isolated, "Load meshes in a process of their own, bounded in time and memory");

  bench::BenchOptions bench_options;
  CLI::App* measure = app.add_subcommand("bench", "Measure the contact loop, FCL beside it, and the linear programme");
  measure->add_option("--scene", bench_options.scenes, "Only this scene (may be repeated)")
      ->check(CLI::IsMember(bench::scene_names()))
      ->type_name("NAME");
  measure->add_flag("--quick", bench_options.quick, "A short look: one round of the pen, small programmes");
  measure->add_flag("--budgets", bench_options.budgets, "Also with tick budgets of 0.1 and 0.3 ms");
  measure->add_option("--resolver", bench_options.resolver, "Contact resolver (the library's default unless told)")
      ->type_name("NAME");
  measure->add_flag("--json", bench_options.json, "Print the figures as one line of JSON");
  measure->add_option("--markdown", bench_options.markdown, "Also replace the generated part of this file")
      ->type_name("FILE");
  bench_options.command = "tegotae";
  for (int i = 1; i < argc; ++i) bench_options.command += std::string(" ") + argv[i];

  return guarded_main(app, argc, argv, [&] {
    const MeshLoader load = [isolated](const std::string& file, double unit) {
      return isolated ? load_mesh_isolated(file, unit) : load_mesh(file, unit);
    };
    if (check->parsed()) return check_files(files, load);
    if (measure->parsed()) return bench::run_bench(bench_options);
    return run_and_report(load_scene(scene, load), options, scene);
  });
}
