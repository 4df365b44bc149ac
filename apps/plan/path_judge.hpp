#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "tegotae/loop/scene.hpp"

namespace tegotae::plan {

/// What FCL says of a path.
struct PathVerdict {
  std::int64_t poses = 0;         ///< of the path, 20 µm apart
  std::int64_t intersecting = 0;  ///< of them, where triangles meet
};

/// FCL about paths of the held part, at poses between which none of its points goes more than 20 µm; knows nothing of
/// the planners. Poses that FCL's distance at an earlier one leaves no doubt about are counted and not asked again.
/// Uses all processors.
class PathJudge {
 public:
  ~PathJudge();
  /// `center` of mass of the held part (file frame, m) goes straight between two poses. Keeps a reference to the scene.
  PathJudge(const Scene& scene, const Vec3& center);

  PathVerdict ask(const std::vector<Pose>& path);

 private:
  class Asked;

  /// A motion in steps, and at how many of them FCL finds contact.
  struct Motion {
    Pose from = {};
    Displacement d = {};
    double way = 0;  ///< that no point exceeds, m
    int steps = 0;
    std::int64_t intersecting = 0;
  };

  Motion motion(const Pose& from, const Pose& to) const;
  /// Of a motion's steps from `first` to `last`.
  std::int64_t intersecting(const Motion& m, int first, int last, Asked& fcl) const;

  const Scene& scene_;
  Vec3 center_;
  std::vector<Vec3> points_;                              ///< of the held part, from its center, m
  std::vector<std::unique_ptr<Asked>> fcl_;               ///< one for each processor
  std::map<std::array<double, 14>, Motion> asked_about_;  ///< by both poses: other seeds share many motions
};

}  // namespace tegotae::plan
