#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tegotae/loop/initial_contacts.hpp"
#include "tegotae/loop/scene.hpp"

namespace tegotae {

/// How far a planner has come.
struct PlanProgress {
  const char* what;             ///< "searching", "shortening", "searching for a wider way", "certifying"
  std::int64_t iterations = 0;  ///< of the search, made
  std::size_t poses = 0;        ///< that are known to be within reach
  double way = 0;               ///< m, of the center of mass: the farthest of them from the start
};

/// What a plan is to be.
struct PlanOptions {
  std::optional<Pose> goal = {};  ///< X_WF of the held part; none: out of all other parts (Exit)
  double clearance = 0;           ///< m that the path leaves at least; 0: what the contact loop leaves, 1.1 µm
  std::uint64_t seed = 1;
  std::int64_t iterations = 20000;                         ///< of the search, at most
  std::function<bool()> search_ends = {};                  ///< asked in the search: whether to give it up; empty: no
  std::function<bool()> ends = {};                         ///< asked all the time: whether to end with what there is
  const std::atomic<bool>* stop = nullptr;                 ///< set it to end with what there is; null: disabled
  std::function<void(const PlanProgress&)> progress = {};  ///< ten times a second or less, and where `what` is another
};

/// A part that stopped motions of the search.
struct PartInTheWay {
  std::size_t part = 0;    ///< index into Scene::parts
  std::int64_t stops = 0;  ///< motions from the start's side that it stopped
};

/// What a planner found.
struct Plan {
  bool found = false;
  bool interrupted = false;  ///< by PlanOptions::stop
  bool out_of_time = false;  ///< ended by PlanOptions::ends
  /// Poses X_WF of the held part; between two of them its center of mass goes straight and it turns at a constant rate.
  /// It begins where the held part starts in a contact loop. Without a solution: the way to the farthest pose reached.
  std::vector<Pose> path;
  /// m: the whole path is proved to leave this much to every other part. Pairs in `start` that have not come free: to
  /// the copy of the part that is smaller by InitialContact::inward_offset. 0: not proved, which is not a solution.
  double clearance = 0;
  Vec3 center;                           ///< of mass of the held part, m, file frame
  InitialContactReport start;            ///< what the held part touches at the start
  double way = 0;                        ///< m, of the center of mass: from the start to the farthest pose reached
  double turn = 0;                       ///< rad, of the farthest turn from the start that was reached
  std::vector<PartInTheWay> in_the_way;  ///< those that stopped most motions first
  std::int64_t iterations = 0;           ///< of the search
  std::size_t poses = 0;                 ///< that the search reached
  std::int64_t motions = 0;              ///< that the certificate was asked about
  std::int64_t complied = 0;             ///< that the contact loop was led through
  double seconds = 0;                    ///< that it took
  double search_cpu = 0, cpu = 0;        ///< s of the process's processor time: of the search, and in all
};

/// Whether this build has a planner, and what is missing where it has none.
bool has_planner();
std::string missing_planner();

/// Looks for a path of the held part to a goal, or out. The same scene, options and build give the same plan as long as
/// neither `search_ends` nor `ends` nor `stop` ends it. Throws Error as HapticLoop's constructor, when the goal is not
/// free, when the held part starts nearer to another one than `clearance`, and where has_planner() is false. One at a
/// time in a process: OMPL's random numbers are the process's.
Plan plan_path(const Scene& scene, const PlanOptions& options);

}  // namespace tegotae
