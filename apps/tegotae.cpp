// tegotae: runs scenes and looks at part files.
#include <string>
#include <vector>

#include "check.hpp"
#include "run_options.hpp"

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

  return guarded_main(app, argc, argv, [&] {
    if (check->parsed()) return check_files(files);
    return run_and_report(load_scene(scene), options, scene);
  });
}
