#include "experiments/hold_case.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "experiments/trial.hpp"
#include "models/random_bodies.hpp"
#include "tegotae/loop/haptic_loop.hpp"

namespace tegotae::experiments {
namespace {

constexpr int kPushTicks = 500, kSettleTicks = 500, kWatchedTicks = 500;

struct Range {
  double low = INFINITY, high = -INFINITY;
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  double width() const { return high - low; }
};

}  // namespace

Held hold_case(const std::string& resolver, unsigned seed) {
  std::mt19937 rng(seed);
  Scene scene;
  scene.contact.resolver = resolver_kind(resolver);
  scene.contact.tick_budget = INFINITY;
  const bool convex = seed % 2 == 1;
  const auto body = [&](double size) {
    return std::make_shared<const TriangleMesh>(convex ? shapes::random_convex_body(rng, 14, size)
                                                       : shapes::random_star_body(rng, 14, size));
  };
  const int parts = 2 + static_cast<int>(seed % 3);
  for (int k = 0; k < parts; ++k) {
    const double angle = 2 * M_PI * k / parts;
    scene.parts.push_back(
        {"fixed" + std::to_string(k),
         body(0.03),
         {rotation(3 * shapes::random_direction(rng)), {0.03 * std::cos(angle), 0.03 * std::sin(angle), 0}},
         false});
  }
  scene.parts.push_back({"held", body(0.02), {Quat::Identity(), {0, 0, 0.09}}, true});
  HapticLoop loop(scene);
  const Vec3 spin = shapes::random_vector(rng, 5e-4);
  Pose Y = scene.parts.back().pose;
  for (int tick = 0; tick < kPushTicks; ++tick) {
    Y = {rotation(static_cast<double>(tick) * spin), {0, 0, 0.09 - 2e-4 * tick}};
    loop.step(Y, 0.001);
  }
  for (int tick = 0; tick < kSettleTicks; ++tick) loop.step(Y, 0.001);
  unexplained_lag_ticks() += loop.report().unexplained_lag_ticks;
  const ProxyState rest = loop.report().proxy;
  Held held;
  held.touching = rest.touching;
  if (!held.touching) return held;
  Range x[6], force;
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

}  // namespace tegotae::experiments
