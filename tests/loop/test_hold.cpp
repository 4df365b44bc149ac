// A still pen gives a still part: random bodies wedged between two to four others by a pen that comes to rest inside.
#include <cstdio>

#include "catch.hpp"
#include "experiments/hold_case.hpp"
#include "experiments/trial.hpp"

using namespace tegotae::experiments;

namespace {

constexpr int kConfigurations = 200;

}  // namespace

TEST_CASE("a still pen gives a still part", "[sim]") {
  const std::string resolver = GENERATE("qp", "lp");
  CAPTURE(resolver);
  int held = 0, moving = 0;
  double moved = 0, turned = 0, force_change = 0;
  const std::int64_t unexplained = unexplained_lag_ticks();
  for (unsigned seed = 1000; held < kConfigurations; ++seed) {
    const Held h = hold_case(resolver, seed);
    if (!h.touching) continue;  // the pen went past the others
    ++held;
    moving += h.moved > 1e-6 || h.turned > 1e-4 || h.force_change > 0.01 ? 1 : 0;
    moved = std::max(moved, h.moved);
    turned = std::max(turned, h.turned);
    force_change = std::max(force_change, h.force_change);
  }
  std::printf("hold %s: %d of %d still move; at most %.3g um, %.3g mrad, %.3g %% of the force\n", resolver.c_str(),
              moving, held, 1e6 * moved, 1e3 * turned, 100 * force_change);
  CHECK(moved < 1e-6);
  CHECK(turned < 1e-4);
  CHECK(force_change < 0.01);
  CHECK(unexplained_lag_ticks() == unexplained);
}
