#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "review/clearance_band.hpp"
#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae::plan {

struct PlanCommand {
  std::string scene, hold;
  std::string goal;  ///< empty: out of the other parts
  bool out = false;  ///< said so
  bool all = false;  ///< take everything apart
  double clearance = 0;
  std::optional<review::ClearanceBand> band;
  std::optional<std::uint64_t> seed;
  std::optional<std::int64_t> iterations;
  std::optional<double> seconds;
  std::string folder = "plan";  ///< for what it writes
  bool json = false;
  MeshLoader load;  ///< reads the meshes
};

/// The subcommand `plan`.
CLI::App* add_plan(CLI::App& app, PlanCommand& options);

/// Plans, writes the path and says what came out. Returns the exit code. Throws Error.
int run_plan(const PlanCommand& options);

}  // namespace tegotae::plan
