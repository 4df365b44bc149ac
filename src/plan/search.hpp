#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "plan/exit.hpp"
#include "plan/motion_world.hpp"

namespace tegotae {

/// What a search looks for, and for how long.
struct SearchTask {
  Pose start;
  std::vector<Pose> goals;     ///< one of them is to be reached; all free
  const Exit* exit = nullptr;  ///< whatever is out by this has arrived too; null: the goals alone
  WorldBox room;               ///< for the center of mass, m
  /// A path from the start that is known, of less clearance than the world's: trees grow along it too. Empty: none.
  std::vector<Pose> known;
  std::uint64_t seed = 1;
  std::int64_t iterations = 0;
  std::function<bool()> ended;  ///< whether to stop at once
  /// Told after every iteration.
  std::function<void(std::int64_t iterations, std::size_t poses, double way)> progress;
};

/// What a search found.
struct SearchResult {
  bool found = false;
  std::vector<Pose> path;                     ///< to the goal, else to the pose farthest from the start (by its center)
  double way = 0;                             ///< m, of the center, to the farthest pose from the start's side
  double turn = 0;                            ///< rad, of the farthest turn
  std::map<std::size_t, std::int64_t> stops;  ///< motions from the start's side that each part of the scene stopped
  std::int64_t iterations = 0;
  std::size_t poses = 0;
};

/// Completes the world and searches with two trees of poses, one from the start and one from the goals. An edge is a
/// motion that the path certificate proves free, or, where that is stopped, one that the contact loop makes when its
/// pen is led on.
SearchResult search(MotionWorld& world, const SearchTask& task);

/// How a path is shortened.
struct ShortenTask {
  WorldBox room;         ///< as SearchTask::room
  double clearance = 0;  ///< m, that motions leave which replace others
  std::uint64_t seed = 1;
  std::function<bool()> ended;    ///< whether to begin nothing new
  std::function<bool()> stopped;  ///< whether to leave the path as it is at once: then no motion replaces others
};

/// Shortens a path; what cannot be replaced stays.
std::vector<Pose> shorten(MotionWorld& world, const std::vector<Pose>& path, const ShortenTask& task);

}  // namespace tegotae
