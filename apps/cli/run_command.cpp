#include "cli/run_command.hpp"

#include <algorithm>
#include <iostream>

#include "core/number_text.hpp"
#include "import/file_check.hpp"
#include "session/run_length.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::apps {
namespace {

// s: of longer scripts the length is said before they run.
constexpr double kLongScript = 3600;

/// What a run of a file of parts cannot be, before its parts are read.
void check_parts(const RunCommand& options) {
  const std::string& file = options.open.file;
  if (options.script.empty() && options.run.device.empty() && !options.run.view)
    throw Error(file + ": a file of parts has no script, so nothing would move: `tegotae view " + file +
                "` takes the mouse; or give --script FILE or --device shm:NAME");
  if (!options.run.record.empty())
    throw Error(file + ": a recording names its scene, and a file of parts has none: first `tegotae import " + file +
                " -o FOLDER`, then run FOLDER/scene.toml");
}

/// A run in which nothing moves says so.
void note_rest(const RunCommand& options, const SceneFile& file) {
  const bool led = !options.run.device.empty() || options.run.view;
  if (led || file.script.end() > file.script.begin()) return;
  const auto& parts = file.scene.parts;
  const auto held = std::find_if(parts.begin(), parts.end(), [](const Part& p) { return p.held; });
  if (held == parts.end()) return;
  std::cerr << "tegotae: note: the scene has no script, so nothing moves " << held->name
            << ": --view takes the mouse, --device shm:NAME a pen, --script FILE a script\n";
}

/// A script of other times than seconds is often long: in virtual time nothing else says why the run does not end.
void note_length(const RunCommand& options, const SceneFile& file) {
  const double length = file.script.end() - file.script.begin();
  if (length <= kLongScript || length > kMaxRunSeconds || options.run.seconds > 0 || !options.run.device.empty() ||
      options.run.view)
    return;
  std::cerr << "tegotae: note: the script lasts " << number_text(length, 6) << " s (" << number_text(length / 3600, 3)
            << " hours); --seconds S ends the run before\n";
}

}  // namespace

CLI::App* add_run(CLI::App& app, RunCommand& options) {
  CLI::App* run = app.add_subcommand("run", "Run a scene: its pen, servo and contact loop");
  run->add_option("SCENE", options.open.file, "Scene file (TOML); or STEP, glTF, 3MF, STL, OBJ, PLY, OFF")->required();
  run->add_option("--hold", options.open.hold, "Name of the part to hold, overrides the scene's")->type_name("NAME");
  run->add_option("--script", options.script, "Stylus script (CSV) instead of the scene's")->type_name("FILE");
  add_unit_option(*run, options.open.import);
  add_guide_option(*run, options.run);
  add_run_options(*run, options.run);
  run->add_option("--seconds", options.run.seconds, "How long to run (default: to the end of the script)")
      ->check([](const std::string& text) -> std::string {
        double value = 0;  // CLI::PositiveNumber lets nan pass
        if (CLI::detail::lexical_cast(text, value) && value > 0 && value <= kMaxRunSeconds) return "";
        return text + " is not a positive number up to " + number_text(kMaxRunSeconds, 9);
      })
      ->type_name("S");
  return run;
}

int run_scene(const RunCommand& options, const MeshLoader& load) {
  require_file(options.open.file);
  if (is_file_of_parts(options.open.file)) check_parts(options);
  OpenOptions open = options.open;
  open.quiet = options.run.json;
  return with_scene(open, load, [&](SceneFile file) {
    if (!options.script.empty()) {
      file.script = read_script(options.script);
      file.files.push_back(options.script);
    }
    note_rest(options, file);
    note_length(options, file);
    return run_and_report(std::move(file), options.run, options.open.file);
  });
}

}  // namespace tegotae::apps
