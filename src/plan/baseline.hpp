#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "plan/exit.hpp"
#include "tegotae/loop/scene.hpp"

namespace tegotae {

/// What the planner is compared with: OMPL's RRT-Connect with FCL as its collision checker.
struct BaselineTask {
  Vec3 center;          ///< of mass of the held part, m, file frame
  double gyration = 0;  ///< its radius of gyration, m
  std::vector<Pose> goals;
  WorldBox room;       ///< for the center of mass, m
  double step = 1e-4;  ///< m, of what the center goes and the turn times `gyration`: FCL is asked so often
  std::uint64_t seed = 1;
  std::function<bool()> ended;  ///< whether to stop
};

struct BaselineResult {
  bool found = false;
  std::vector<Pose> path;
  std::int64_t asked = 0;  ///< poses that FCL was asked about
};

/// Searches from where the scene holds the part. Throws Error where there is no OMPL.
BaselineResult rrt_connect(const Scene& scene, const BaselineTask& task);

}  // namespace tegotae
