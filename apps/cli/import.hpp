#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/watched_child.hpp"
#include "tegotae/import/assembly.hpp"

namespace tegotae::apps {

struct ImportOptions {
  std::string file;
  std::string folder;
  std::string hold;  ///< name of the part to hold; empty: none
  AssemblyOptions assembly;
  bool quiet = false;  ///< nothing on stdout
  ChildBounds bounds;
};

/// Adds the subcommand `import`.
CLI::App* add_import(CLI::App& app, ImportOptions& options);

/// Turns a file of parts into a folder with a scene file and a mesh for each distinct shape. Returns the exit code.
int import_file(const ImportOptions& options);

}  // namespace tegotae::apps
