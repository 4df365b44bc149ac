// Random bodies pushed into each other by random pens: no committed pose may intersect, asked of FCL in world poses.
#include "bodies.hpp"
#include "catch.hpp"
#include "fcl_oracle.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::test;

TEST_CASE("random bodies pushed into each other never intersect, and follow the pen when free", "[sim]") {
  const std::string resolver = GENERATE("lp", "qp");
  CAPTURE(resolver);
  std::mt19937 rng(61);
  int touching = 0, ticks = 0;
  for (int round = 0; round < 15; ++round) {
    CAPTURE(round);
    Scene scene;
    scene.contact.resolver = resolver_kind(resolver);
    scene.contact.tick_budget = INFINITY;
    const bool convex = round % 2 == 0;
    const auto body = [&](double size) {
      return shared(convex ? random_convex_body(rng, 14, size) : random_star_body(rng, 14, size));
    };
    for (int k = 0; k < 3; ++k) {
      const double angle = 2 * M_PI * k / 3;
      scene.parts.push_back(
          {"fixed" + std::to_string(k),
           body(0.03),
           {rotation(3 * random_direction(rng)), {0.045 * std::cos(angle), 0.045 * std::sin(angle), 0}},
           false});
    }
    scene.parts.push_back({"held", body(0.02), {Quat::Identity(), {0, 0, 0.09}}, true});
    HapticLoop loop(scene);
    FclOracle oracle(scene);
    Vec3 target(0, 0, 0.09), spin = random_vector(rng, 1e-3);
    for (int tick = 0; tick < 500; ++tick) {
      const Vec3 goal(0.03 * std::sin(0.01 * tick), 0.03 * std::cos(0.013 * tick), -0.03);
      target += (goal - target).normalized() * std::min(2e-4, (goal - target).norm());
      const TickReport& r = loop.step({rotation(static_cast<double>(tick) * spin), target}, 0.001);
      for (const Pose& piece : r.substeps) REQUIRE(oracle.intersecting(piece).empty());
      REQUIRE(r.status != ResolveStatus::stalled);
      touching += r.proxy.touching ? 1 : 0;
      ++ticks;
    }
  }
  REQUIRE(touching > ticks / 20);
}
