#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "cli/import.hpp"
#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae::apps {

/// A scene to be opened, or a file of parts that becomes one.
struct OpenOptions {
  std::string file;
  std::string hold;         ///< name of the part to hold; empty: the scene's
  bool held_needed = true;  ///< false: nothing is held where neither `hold` nor the scene names a part
  bool quiet = false;       ///< nothing on stdout, and no line that tells how far it is
  ImportOptions import;     ///< of a file of parts
};

/// Adds the options that are about a file of parts.
void add_unit_option(CLI::App& app, ImportOptions& options);

/// Loads the scene `options.file`, or imports the parts in it into a temporary folder. In a scene of parts nobody has
/// said which one is held: the smallest where one has to be, unless `options.hold` is another; parts that overlap at
/// the start are let be. Calls `then` while the folder is there. Returns its exit code, or the import's when that
/// fails; throws Error.
int with_scene(const OpenOptions& options, const MeshLoader& load, const std::function<int(SceneFile)>& then);

}  // namespace tegotae::apps
