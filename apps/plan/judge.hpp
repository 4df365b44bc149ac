#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tegotae/loop/scene.hpp"

namespace tegotae::plan {

/// A scene whose held part is to come out.
struct JudgedScene {
  std::string name;
  Scene scene;
  bool comes_out = true;  ///< by construction, or by who made the parts
};

/// The puzzles of the model generator, and the pairs of real parts listed in `parts`/pairs.json (empty: none). Throws
/// Error.
std::vector<JudgedScene> judged_scenes(const std::string& parts);

/// One planner over all seeds of a scene.
struct PlannerFigures {
  int found = 0;
  std::vector<double> cpu;        ///< s of processor time to the first path, of those that were found
  std::vector<double> whole_cpu;  ///< the same with shortening and certifying
  std::int64_t checked = 0;       ///< poses that FCL was asked about on their paths, 20 µm apart
  std::int64_t intersecting = 0;  ///< of them
  int bad_paths = 0;              ///< paths with one
  double clearance = 0;           ///< m, the least that was certified; 0: of none
};

struct JudgedFigures {
  PlannerFigures ours, baseline;
};

struct JudgeOptions {
  int seeds = 10;
  double seconds = 10;  ///< of processor time for a search
};

/// Both planners on one scene, by turns; `progress` is told what is done next.
JudgedFigures judge(const JudgedScene& scene, const JudgeOptions& options,
                    const std::function<void(int seed, const char* what)>& progress);

}  // namespace tegotae::plan
