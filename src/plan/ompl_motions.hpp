// The certificate of a MotionWorld as OMPL asks for it.
#pragma once

#include <functional>
#include <memory>

#include "plan/motion_world.hpp"
#include "plan/ompl_space.hpp"

namespace tegotae {

/// What OMPL needs to know of `space`: a state or a motion is valid when it is proved to leave `clearance` (m), and
/// none is once `stopped` says so. Keeps a reference to the world.
ompl::base::SpaceInformationPtr space_information(const std::shared_ptr<PoseSpace>& space, MotionWorld& world,
                                                  double clearance, std::function<bool()> stopped);

}  // namespace tegotae
