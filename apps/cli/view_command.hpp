#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/open_scene.hpp"
#include "shared/run_options.hpp"
#include "tegotae/scene_file/scene_file.hpp"
#include "view/replay.hpp"

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

struct ReplayOptions {
  std::string recording;
  std::string scene;  ///< file; empty: the one that the recording names
  std::string html;   ///< file to write the page to; empty: it is served
  std::size_t frames = view::kMaxFrames;
  PageOptions page;
  MeshLoader load;  ///< reads the meshes
};

/// Adds the subcommand `replay`.
CLI::App* add_replay(CLI::App& app, ReplayOptions& options);

/// Serves a page with a recording until Ctrl-C, or writes it to a file. Returns the exit code; throws Error.
int show_recording(const ReplayOptions& options);

}  // namespace tegotae::apps
