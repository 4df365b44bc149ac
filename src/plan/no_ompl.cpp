// What stands in for the search where OMPL was not there when the library was built.
#include "plan/baseline.hpp"
#include "plan/planner.hpp"
#include "plan/search.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

bool has_planner() {
  return false;
}

std::string missing_planner() {
  return "this build has no planner: install OMPL (Debian: libompl-dev), configure and build again";
}

SearchResult search(MotionWorld&, const SearchTask&) {
  throw Error(missing_planner());
}

BaselineResult rrt_connect(const Scene&, const BaselineTask&) {
  throw Error(missing_planner());
}

std::vector<Pose> shorten(MotionWorld&, const std::vector<Pose>&, const ShortenTask&) {
  throw Error(missing_planner());
}

}  // namespace tegotae
