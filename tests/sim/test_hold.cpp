// A still pen gives a still part: random bodies wedged between two to four others by a pen that comes to rest inside.
#include <cstdio>

#include "bodies.hpp"
#include "catch.hpp"
#include "tegotae/sim/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr int kConfigurations = 200;
constexpr int kPushTicks = 500, kSettleTicks = 500, kWatchedTicks = 500;

struct Spread {
  double low = INFINITY, high = -INFINITY;
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  double width() const { return high - low; }
};

/// What moved in the watched time; all zero when nothing touches in the end.
struct Held {
  bool touching = false;
  double moved = 0, turned = 0, force_change = 0;
};

Held hold(const std::string& resolver, unsigned seed) {
  std::mt19937 rng(seed);
  Scene scene;
  scene.contact.resolver = resolver;
  scene.contact.tick_budget = INFINITY;
  const bool convex = seed % 2 == 1;
  const auto body = [&](double size) {
    return shared(convex ? random_convex_body(rng, 14, size) : random_star_body(rng, 14, size));
  };
  const int parts = 2 + static_cast<int>(seed % 3);
  for (int k = 0; k < parts; ++k) {
    const double angle = 2 * M_PI * k / parts;
    scene.parts.push_back({"fixed" + std::to_string(k),
                           body(0.03),
                           {rotation(3 * random_direction(rng)), {0.03 * std::cos(angle), 0.03 * std::sin(angle), 0}},
                           false});
  }
  scene.parts.push_back({"held", body(0.02), {Quat::Identity(), {0, 0, 0.09}}, true});
  HapticLoop loop(scene);
  const Vec3 spin = random_vector(rng, 5e-4);
  Pose Y = scene.parts.back().pose;
  for (int tick = 0; tick < kPushTicks; ++tick) {
    Y = {rotation(static_cast<double>(tick) * spin), {0, 0, 0.09 - 2e-4 * tick}};
    loop.step(Y, 0.001);
  }
  for (int tick = 0; tick < kSettleTicks; ++tick) loop.step(Y, 0.001);
  const ProxyState rest = loop.report().proxy;
  Held held;
  held.touching = rest.touching;
  if (!held.touching) return held;
  Spread x[6], force;
  for (int tick = 0; tick < kWatchedTicks; ++tick) {
    const ProxyState& now = loop.step(Y, 0.001).proxy;
    const Displacement d = displacement(rest.X, now.X, loop.center());
    for (int k = 0; k < 3; ++k) {
      x[k].add(d.dp[k]);
      x[3 + k].add(d.dr[k]);
    }
    force.add(coupling_wrench(scene.coupling, now, Y, Twist{}, loop.center()).force.norm());
  }
  for (int k = 0; k < 3; ++k) {
    held.moved = std::max(held.moved, x[k].width());
    held.turned = std::max(held.turned, x[3 + k].width());
  }
  held.force_change = force.width() / force.high;
  return held;
}

}  // namespace

TEST_CASE("a still pen gives a still part", "[sim]") {
  const std::string resolver = GENERATE("qp", "lp");
  CAPTURE(resolver);
  int held = 0, moving = 0;
  double moved = 0, turned = 0, force_change = 0;
  for (unsigned seed = 1000; held < kConfigurations; ++seed) {
    const Held h = hold(resolver, seed);
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
}
