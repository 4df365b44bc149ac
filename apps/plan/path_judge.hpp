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
/// the planners. A pose about which FCL's distance at another one leaves no doubt, because no point of the part is
/// farther than that from where it was there, is counted and not asked about: on the same path, or on an earlier one.
/// Uses all processors.
class PathJudge {
 public:
  ~PathJudge();
  /// `center` of mass of the held part (file frame, m) goes straight between two poses. Keeps a reference to the scene.
  PathJudge(const Scene& scene, const Vec3& center);

  PathVerdict ask(const std::vector<Pose>& path);
  /// How often FCL was asked for a collision or a distance.
  std::int64_t asked() const;

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
  /// A pose that is clear by FCL's distance: so is every one at which no point is as much as `reach` (m) from there.
  struct Clear {
    Vec3 center;  ///< of the held part, m
    Mat3 turn;
    double reach;
  };
  /// Steps of a motion from `first` to `last`, which one job asks about, and what it found.
  struct Run {
    Motion* motion;
    int first, last;
    std::int64_t intersecting = 0;
    std::vector<Clear> clear = {};
  };

  Motion motion(const Pose& from, const Pose& to) const;
  void look_at(Run& run, Asked& fcl) const;
  /// How far all points may go on from a pose before FCL has to be asked, m; 0: it has to be now. `near`: index of a
  /// pose that may be near, set to the one that was.
  double spared(const Vec3& center, const Mat3& turn, std::size_t& near) const;

  Vec3 center_;
  std::vector<Vec3> points_;                              ///< of the held part, from its center, m
  std::vector<std::unique_ptr<Asked>> fcl_;               ///< one for each processor
  std::map<std::array<double, 14>, Motion> asked_about_;  ///< by both poses: other seeds share many motions
  std::vector<Clear> clear_;                              ///< of the paths before
};

}  // namespace tegotae::plan
