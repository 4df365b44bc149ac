// Ticks with little time: what is cut is said to be cut, and X stays free. How long ticks take is not tested here: it
// depends on what else the machine does.
#include "catch.hpp"
#include "stress_run.hpp"

using namespace tegotae;
using namespace tegotae::test;

TEST_CASE("within any budget X stays free, and ticks that ran out of it say so", "[budget]") {
  StressOptions options;
  options.resolver = GENERATE("lp", "qp");
  options.budget = GENERATE(1e-6, 1e-4, 3e-4, 8e-4);
  const std::string name = GENERATE("peg_0.99", "peg_0.999", "knots", "wedged_stars");
  CAPTURE(options.resolver, options.budget, name);
  StressResult sum;
  LatencyHistogram cpu;
  for (unsigned seed = 81; seed < 84; ++seed) sum.add(run_stress_script(stress_scene(name, seed), seed, options, cpu));
  CAPTURE(sum.first_intersecting);
  CHECK(sum.intersecting == 0);
  CHECK(sum.infeasible == 0);
  // An interrupt after the last look at the clock counts as the thread's time: one tick in ten thousand, never two
  // here.
  CHECK(sum.late_unreported <= 1 + sum.ticks / 1000);
  // No machine searches a peg in its hole within a microsecond.
  if (options.budget == 1e-6 && name != "knots") CHECK(sum.cut > 0);
}
