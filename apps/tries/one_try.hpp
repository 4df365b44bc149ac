#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "tegotae/scene_file/scene_file.hpp"
#include "tries/routes.hpp"

namespace tegotae::tries {

/// What is tried.
struct Task {
  SceneFile file;  ///< its script goes from the start to the goal
  Vec3 center;     ///< of mass of the held part, m, file frame
  std::vector<Route> routes;
  std::uint64_t seed = 1;
  double seconds = 20;  ///< that an operator has, s
};

/// The task of bringing the held part of `file` to `goal`. Throws Error.
Task make_task(SceneFile file, const Pose& goal, std::uint64_t seed, double seconds);

/// How a try went.
struct Result {
  int number = 0;                 ///< from 0
  std::string who, route;         ///< operator profile, route
  double offset = 0, tilt = 0;    ///< by which it was led astray at first, m and rad
  bool reached = false;           ///< the goal, and the part stayed there
  double time = 0;                ///< s, until it was there, or the time tried
  double depth = 0;               ///< along the straight way to the goal at the end, m
  double force = 0, torque = 0;   ///< largest rendered, N, N·m
  double stuck = 0;               ///< time spent wiggling, s
  std::int64_t intersecting = 0;  ///< poses, by FCL
  std::string blocked_by;         ///< the part in contact in the last half second, most of the time; empty: none
  Vec3 place_W = Vec3::Zero();    ///< middle of the last contacts with it, m
};

/// Try `number`; the same task, seed and number give the same result. Empty when `stop` was set meanwhile. `record`:
/// file of the recording, or none.
std::optional<Result> run_try(const Task& task, int number, const std::atomic<bool>& stop,
                              const std::string& record = {});

}  // namespace tegotae::tries
