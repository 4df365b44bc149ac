// A still pen gives a still part: random bodies wedged between two to four others by a pen that comes to rest inside.
#include <cstdio>

#include "catch.hpp"
#include "experiments/hold_case.hpp"
#include "experiments/trial.hpp"

using namespace tegotae::experiments;

namespace {

constexpr int kConfigurations = 200;

struct Moving {
  int held = 0, moving = 0;
  double moved = 0, turned = 0, force_change = 0;

  void add(const Held& h) {
    if (!h.touching) return;  // the pen went past the others
    ++held;
    moving += h.moved > 1e-6 || h.turned > 1e-4 || h.force_change > 0.01 ? 1 : 0;
    moved = std::max(moved, h.moved);
    turned = std::max(turned, h.turned);
    force_change = std::max(force_change, h.force_change);
  }

  void check(const std::string& name) const {
    std::printf("hold %s: %d of %d still move; at most %.3g um, %.3g mrad, %.3g %% of the force\n", name.c_str(),
                moving, held, 1e6 * moved, 1e3 * turned, 100 * force_change);
    CHECK(moved < 1e-6);
    CHECK(turned < 1e-4);
    CHECK(force_change < 0.01);
  }
};

}  // namespace

TEST_CASE("a still pen gives a still part", "[sim]") {
  const std::string resolver = GENERATE("qp", "lp");
  CAPTURE(resolver);
  Moving all;
  const std::int64_t unexplained = unexplained_lag_ticks();
  for (unsigned seed = 1000; all.held < kConfigurations; ++seed) all.add(hold_case(resolver, seed));
  all.check(resolver);
  CHECK(unexplained_lag_ticks() == unexplained);
}

// One configuration in a thousand used to swing for good under a still pen: a step towards it lost a gap, the next one
// opened it again. These are the ones of 4000, and some beside each.
TEST_CASE("a part under a still pen does not swing between a lost gap and an opened one", "[sim]") {
  Moving all;
  for (const unsigned swung : {1644u, 1950u, 3238u, 4874u})
    for (unsigned seed = swung - 8; seed <= swung + 8; ++seed) all.add(hold_case("qp", seed));
  CHECK(all.held > 40);
  all.check("beside what swung");
}

// The paper's program may answer with a long way aside that hardly leads to the pen. Of 1000 bodies one stood so 20 um
// short of all others, and said that contacts had nothing to do with it.
TEST_CASE("lp brings a part to contact where its first answer leads aside", "[sim]") {
  const std::int64_t unexplained = unexplained_lag_ticks();
  Moving all;
  for (const unsigned stood : {1038u, 2046u})
    for (unsigned seed = stood - 8; seed <= stood + 8; ++seed) all.add(hold_case("lp", seed));
  CHECK(all.held > 25);
  all.check("lp beside what stood");
  CHECK(unexplained_lag_ticks() == unexplained);
}
