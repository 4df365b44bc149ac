// A build without OMPL: what stands in for the search says which package is missing.
#include "catch.hpp"
#include "models/puzzles.hpp"
#include "plan/planner.hpp"
#include "tegotae/core/error.hpp"

using namespace tegotae;
using Catch::Contains;

TEST_CASE("without OMPL a plan is refused with the package to install") {
  CHECK(!has_planner());
  CHECK_THAT(missing_planner(), Contains("libompl-dev"));
  CHECK_THROWS_WITH(plan_path(shapes::puzzle("loose").scene(), {}), missing_planner());
}
