#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "study/task.hpp"

namespace tegotae::study {

/// How a case went. Of an order: of all its parts together, and of the last one that was tried.
struct Result {
  int number = 0;                       ///< from 0
  std::vector<std::string> parameters;  ///< parameter_cells()
  std::string who, route;               ///< operator profile, route
  double offset = 0, tilt = 0;          ///< by which it was led astray at first, m and rad
  bool reached = false;                 ///< RunSummary::completed, and no pose intersects another part
  double time = 0;                      ///< s, until it was there, or the time tried
  double depth = 0;                     ///< along the straight way to the goal at the end, m
  double force = 0, torque = 0;         ///< largest rendered, N, N·m
  double stuck = 0;                     ///< time spent wiggling, s
  std::int64_t intersecting = 0;        ///< poses, by FCL
  std::string blocked_by;               ///< apps::find_blocker(); empty: none
  Vec3 place_W = Vec3::Zero();          ///< where it was touched last, m
  double clearance = 0;  ///< least distance of the surfaces, m; exact but for a hundredth of the radius of way
  std::string why;       ///< it was not reached, for people; empty: it was
};

/// Called before each task of a case, with the scene as the case has it: where its recording goes; empty: none. It may
/// give the scene another path, which the recording then names.
using RecordTo = std::function<std::string(SceneFile& file, std::size_t task)>;

/// Runs a case in virtual time; the same study and number give the same result. Empty when `stop` was set meanwhile.
/// Throws Error for a scene that cannot be held as its file has it; where a case changes its parts, that is its result.
std::optional<Result> run_case(const Study& study, Tasks& tasks, const Case& c, const std::atomic<bool>& stop,
                               const RecordTo& record_to = {});

}  // namespace tegotae::study
