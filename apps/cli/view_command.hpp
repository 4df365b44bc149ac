#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/open_scene.hpp"
#include "shared/run_options.hpp"
#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae::apps {

struct ViewOptions {
  OpenOptions open;
  RunOptions run;
};

/// Adds the subcommand `view`.
CLI::App* add_view(CLI::App& app, ViewOptions& options);

/// Serves a page that shows `options.file`, whatever it is: a recording, a scene, an assembly or a mesh, until Ctrl-C.
/// Parts are read by `load`. Returns the exit code; throws Error.
int view_file(const ViewOptions& options, const MeshLoader& load);

/// Serves a page with a recording until Ctrl-C, or writes it to the file `html`. An empty `scene` is the one that the
/// recording names. Returns the exit code; throws Error.
int show_recording(const std::string& recording, const std::string& scene, const std::string& html,
                   const PageOptions& page);

}  // namespace tegotae::apps
