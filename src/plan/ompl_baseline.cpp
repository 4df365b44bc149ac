#include <ompl/base/DiscreteMotionValidator.h>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/goals/GoalStates.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>

#include "loop/scene_parts.hpp"
#include "narrowphase/fcl_pairs.hpp"
#include "plan/baseline.hpp"
#include "plan/ompl_space.hpp"

namespace tegotae {

namespace ob = ompl::base;

BaselineResult rrt_connect(const Scene& scene, const BaselineTask& task) {
  seed_ompl(task.seed);
  BaselineResult result;
  FclPairs fcl;
  const Part& held = held_part(scene);
  const auto space = std::make_shared<PoseSpace>(task.center, task.gyration, task.room);
  const auto si = std::make_shared<ob::SpaceInformation>(space);
  si->setStateValidityChecker([&](const ob::State* state) {
    ++result.asked;
    const Pose X = space->pose(state);
    for (const Part& part : scene.parts)
      if (!part.held && fcl.intersect(*held.mesh, *part.mesh, part.pose.inverse() * X)) return false;
    return true;
  });
  si->setStateValidityCheckingResolution(task.step / space->getMaximumExtent());
  si->setMotionValidator(std::make_shared<ob::DiscreteMotionValidator>(si));
  si->setup();
  const auto problem = std::make_shared<ob::ProblemDefinition>(si);
  ob::ScopedState<PoseSpace> state(space);
  space->set(state.get(), held.pose);
  problem->addStartState(state);
  const auto goals = std::make_shared<ob::GoalStates>(si);
  for (const Pose& goal : task.goals) {
    space->set(state.get(), goal);
    goals->addState(state);
  }
  problem->setGoal(goals);
  ompl::geometric::RRTConnect planner(si);
  planner.setProblemDefinition(problem);
  planner.setup();
  result.found = static_cast<ob::PlannerStatus::StatusType>(
                     planner.solve(ob::PlannerTerminationCondition(task.ended))) == ob::PlannerStatus::EXACT_SOLUTION;
  if (result.found) result.path = poses(*space, *problem->getSolutionPath()->as<ompl::geometric::PathGeometric>());
  return result;
}

}  // namespace tegotae
