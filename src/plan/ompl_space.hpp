// Poses of the held part as OMPL has them: center of mass and orientation. The files that include OMPL are
// src/plan/ompl_*.
#pragma once

#include <ompl/base/MotionValidator.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/geometric/PathGeometric.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "plan/exit.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae {

/// Distance: what the center goes and the turn times the held part's radius of gyration, m. OMPL's straight motion in
/// it has a linear center and a constant rate of turning, as the path certificate's.
class PoseSpace final : public ompl::base::SE3StateSpace {
 public:
  PoseSpace(const Vec3& center, double gyration, const WorldBox& room);

  Pose pose(const ompl::base::State* state) const;
  void set(ompl::base::State* state, const Pose& X) const;

 private:
  Vec3 center_;
};

/// Begins OMPL's random numbers anew, so that whatever is made after it repeats, and keeps its console output off.
void seed_ompl(std::uint64_t seed);

/// The poses of a path.
std::vector<Pose> poses(const PoseSpace& space, ompl::geometric::PathGeometric& path);

}  // namespace tegotae
