#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae::study {

struct TryOptions {
  std::string scene, hold;
  std::string goal;           ///< a pose, "out", or empty: where the scene's script ends
  std::string out = "tries";  ///< folder
  int tries = 20, jobs = 0;
  std::uint64_t seed = 1;
  double seconds = 20;
  MeshLoader load;  ///< reads the meshes
};

/// The subcommand `try`.
CLI::App* add_try(CLI::App& app, TryOptions& options);

/// Runs the trials that the folder lacks and prints the outcome. Returns the exit code. Throws Error.
int run_tries(const TryOptions& options);

}  // namespace tegotae::study
