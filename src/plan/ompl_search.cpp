#include <ompl/base/goals/GoalStates.h>
#include <ompl/geometric/PathSimplifier.h>

#include "plan/ompl_connect.hpp"
#include "plan/ompl_motions.hpp"
#include "plan/ompl_space.hpp"
#include "plan/planner.hpp"
#include "plan/search.hpp"

namespace tegotae {

namespace ob = ompl::base;
namespace og = ompl::geometric;

bool has_planner() {
  return true;
}

std::string missing_planner() {
  return "";
}

SearchResult search(MotionWorld& world, const SearchTask& task) {
  seed_ompl(task.seed);
  world.complete();
  SearchResult result;
  const auto space = std::make_shared<PoseSpace>(world.center(), world.gyration(), task.room);
  const auto si = space_information(space, world, world.clearance(), task.ended);
  const auto problem = std::make_shared<ob::ProblemDefinition>(si);
  ob::ScopedState<PoseSpace> start(space);
  space->set(start.get(), task.start);
  problem->addStartState(start);
  const auto goals = std::make_shared<ob::GoalStates>(si);
  for (const Pose& goal : task.goals) {
    ob::ScopedState<PoseSpace> state(space);
    space->set(state.get(), goal);
    goals->addState(state);
  }
  problem->setGoal(goals);
  const ob::PlannerPtr planner = compliant_connect(si, space, world, task, result);
  planner->setProblemDefinition(problem);
  planner->setup();
  planner->solve(ob::PlannerTerminationCondition(task.ended));
  return result;
}

std::vector<Pose> shorten(MotionWorld& world, const std::vector<Pose>& path, const ShortenTask& task) {
  // Rounds until one takes off less than a hundredth.
  constexpr int kMaxRounds = 20;
  constexpr double kWorthwhile = 0.99;
  seed_ompl(task.seed);
  const auto space = std::make_shared<PoseSpace>(world.center(), world.gyration(), task.room);
  const auto si = space_information(space, world, task.clearance, task.stopped);
  og::PathGeometric out(si);
  ob::ScopedState<PoseSpace> state(space);
  for (const Pose& X : path) {
    space->set(state.get(), X);
    out.append(state.get());
  }
  og::PathSimplifier simplifier(si);
  for (int round = 0; round < kMaxRounds && !task.ended(); ++round) {
    const double length = out.length();
    const std::size_t count = out.getStateCount();
    simplifier.reduceVertices(out);
    if (task.ended()) break;
    simplifier.shortcutPath(out);
    const bool fewer = static_cast<double>(out.getStateCount()) < kWorthwhile * static_cast<double>(count);
    if (out.length() > kWorthwhile * length && !fewer) break;
  }
  return poses(*space, out);
}

}  // namespace tegotae
