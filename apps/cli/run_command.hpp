#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/open_scene.hpp"
#include "shared/run_options.hpp"

namespace tegotae::apps {

struct RunCommand {
  OpenOptions open;
  std::string script;  ///< file; empty: the scene's
  RunOptions run;
};

/// Adds the subcommand `run`.
CLI::App* add_run(CLI::App& app, RunCommand& options);

/// Runs a scene, or a file of parts that a pen, the mouse or a script leads. Parts are read by `load`. Returns the exit
/// code; throws Error.
int run_scene(const RunCommand& options, const MeshLoader& load);

}  // namespace tegotae::apps
