#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "study/run_case.hpp"

namespace tegotae::study {

/// A case that was made again.
struct Replay {
  Result result;
  std::vector<std::string> recordings;  ///< of an order one for each part that was tried
  std::string page;                     ///< replays the last recording
};

/// Makes the case again and writes into `folder` its scene, recordings and replay.html, its meshes read by `load`.
/// Empty when `stop` was set meanwhile. Throws Error.
std::optional<Replay> replay_case(const Study& study, Tasks& tasks, int number, const std::string& folder,
                                  const MeshLoader& load, const std::atomic<bool>& stop);

}  // namespace tegotae::study
