#pragma once

#include <ompl/base/Planner.h>

#include <memory>

#include "plan/ompl_space.hpp"
#include "plan/search.hpp"

namespace tegotae {

/// The search as a planner of OMPL: two trees of poses, see search(). Keeps references to `world`, `task` and `result`,
/// which it fills while it solves.
ompl::base::PlannerPtr compliant_connect(const ompl::base::SpaceInformationPtr& si, std::shared_ptr<PoseSpace> space,
                                         MotionWorld& world, const SearchTask& task, SearchResult& result);

}  // namespace tegotae
