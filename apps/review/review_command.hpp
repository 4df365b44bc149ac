#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "review/clearance_band.hpp"
#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae::review {

struct ReviewOptions {
  std::string recording;
  std::string scene;              ///< empty: the one that the recording names
  std::string goal;               ///< empty: where the scene's script ends
  std::string out;                ///< report; empty: beside the recording
  std::string csv, gltf, script;  ///< exports of the path; empty: none
  std::string forces;             ///< the force over depth; empty: none
  std::string mu;                 ///< "LOW:HIGH", see ForceBand; empty: none
  std::optional<ClearanceBand> band;
  bool json = false;  ///< the verdict as one line of JSON
  MeshLoader load;    ///< reads the meshes
};

/// Adds `--band LOW HIGH`, two lengths with units; `band` is left alone unless it is given.
CLI::Option* add_band_option(CLI::App& app, std::optional<ClearanceBand>& band);

/// The subcommand `review`.
CLI::App* add_review(CLI::App& app, ReviewOptions& options);

/// Writes the report and the exports, and prints the verdict. Returns the exit code. Throws Error.
int run_review(const ReviewOptions& options);

/// The report on `recording` over `scene` (empty: the one that it names), whose meshes `load` reads, HTML. Throws
/// Error.
std::string recording_report(const std::string& recording, const std::string& scene, const MeshLoader& load);

}  // namespace tegotae::review
