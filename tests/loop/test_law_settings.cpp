// One law whatever the scene asks for: friction, weight, scale and springs of any kind at once, on parts of 1 mm to 0.1
// m.
#include <array>
#include <cmath>
#include <iostream>

#include "catch.hpp"
#include "coupling/local_model.hpp"
#include "fcl_oracle.hpp"
#include "loop/pocket.hpp"
#include "tegotae/coupling/coupling.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr int kPockets = 24, kWays = 4, kStill = 300;

double uniform(std::mt19937& rng, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(rng);
}

double log_uniform(std::mt19937& rng, double low, double high) {
  return std::exp(uniform(rng, std::log(low), std::log(high)));
}

Scene random_scene(unsigned seed, std::mt19937& rng, double size) {
  Scene scene = pocket(seed, size, 2 + static_cast<int>(seed % 4));
  if (seed % 4 != 0) scene.friction.mu = log_uniform(rng, 0.01, 1);
  scene.weight.on = seed % 3 == 0;
  scene.parts.back().mass = log_uniform(rng, 1e-3, 0.2);
  scene.scale = std::array{0.1, 1.0, 1.0, 4.0}[rng() % 4];
  scene.coupling.stiffness = std::array{200.0, 800.0, 3000.0}[rng() % 3];
  if (seed % 2 == 0)
    scene.max_torsional_stiffness = 3.76;
  else
    scene.coupling.torsional_stiffness = log_uniform(rng, 0.05, 5);
  return scene;
}

struct Worst {
  double sum = 0, cone = 0, servo = 0;  ///< by the springs' force
  double moved = 0;                     ///< by the part's size, in the last ticks of a rest
  int touching = 0, ticks = 0, held = 0, intersecting = 0;
};

/// A wrench by one of `by.force` N on a part of `size` m (of the pen).
double share(const Wrench& w, const Wrench& by, double size) {
  const double force = by.force.norm() + by.torque.norm() / size + 1e-6;
  return std::max(w.force.norm(), w.torque.norm() / size) / force;
}

/// What the springs pull from X to Y, in the hand, less the load.
Wrench springs(const Scene& scene, const HapticLoop& loop, const Pose& X, const Pose& Y, const Wrench& load) {
  const Displacement d = displacement(X, Y, loop.center());
  return {-loop.coupling().stiffness / scene.scale * d.dp - load.force,
          -loop.coupling().torsional_stiffness * d.dr - load.torque};
}

Wrench less(const Wrench& a, const Wrench& b) {
  return {a.force - b.force, a.torque - b.torque};
}

/// The report of a tick with the pen at `Y`.
void look(const Scene& scene, const HapticLoop& loop, const Pose& Y, double size, Worst& worst) {
  const TickReport& r = loop.report();
  ++worst.ticks;
  if (!r.proxy.touching || !r.forces.available) return;
  ++worst.touching;
  const Wrench whole = springs(scene, loop, r.proxy.X, Y, r.proxy.load);
  const Wrench sum = r.forces.sum(r.proxy.X * loop.center(), scene.scale);
  worst.sum = std::max(worst.sum, share(less(less(whole, sum), r.forces.lag), whole, size / scene.scale));
  for (int i = 0; i < r.forces.count; ++i) {
    const ContactForce& c = r.forces.items[static_cast<std::size_t>(i)];
    REQUIRE(c.force > 0);
    // A plane that holds one motion only does not rub.
    REQUIRE((c.mu == scene.friction.mu || c.mu == 0));
    worst.cone = std::max(worst.cone, (c.friction.norm() - c.mu * c.force) / (whole.force.norm() + 1e-6));
    REQUIRE(std::abs(c.friction.dot(c.n)) <= 1e-9 * (1 + c.friction.norm()));
  }
}

/// What the servo renders under a pen at rest is what the contacts exert.
void compare_servo(const Scene& scene, const HapticLoop& loop, const Pose& Y, double size, Worst& worst) {
  const TickReport& r = loop.report();
  if (!r.proxy.touching || r.forces.count == 0) return;
  ++worst.held;
  LocalModel model;
  ProxyState x = r.proxy;
  const Pose goal = loaded(Y, loop.center(), loop.coupling(), scene.scale, r.proxy.load);
  model.update(r.planes, coupling_radius(loop.coupling(), scene.scale), loop.center(), goal, {}, x);
  const Wrench felt = springs(scene, loop, x.X, Y, r.proxy.load);
  const Wrench sum = r.forces.sum(r.proxy.X * loop.center(), scene.scale);
  worst.servo = std::max(worst.servo, share(less(felt, sum), felt, size / scene.scale));
}

void run(unsigned seed, Worst& worst) {
  std::mt19937 rng(seed);
  const double size = log_uniform(rng, 1e-3, 0.1);
  const Scene scene = random_scene(seed, rng, size);
  HapticLoop loop(scene);
  const FclOracle oracle(scene);
  const Pose home = scene.parts.back().pose;
  Pose from = home;
  for (int way = 0; way < kWays; ++way) {
    const Pose to = {rotation(uniform(rng, 0, 0.8) * random_direction(rng)) * home.q,
                     home.p + random_vector(rng, 0.5 * size) - Vec3(0, 0, uniform(rng, 3, 6) * size)};
    const Displacement d = displacement(from, to, Vec3::Zero());
    const int ticks = 100 + static_cast<int>(rng() % 100);
    Pose last;
    for (int i = 1; i <= ticks + kStill; ++i) {
      const Pose Y = displaced(from, Vec3::Zero(), std::min(1.0, 1.0 * i / ticks) * d);
      const TickReport& r = loop.step(Y, 1e-3);
      look(scene, loop, Y, size, worst);
      for (const Pose& X : r.substeps) worst.intersecting += oracle.intersecting(X).empty() ? 0 : 1;
      if (i > ticks + kStill - 50) {
        const Displacement moved = displacement(last, r.proxy.X, loop.center());
        worst.moved = std::max(worst.moved, moved.dp.norm() / size + moved.dr.norm());
      }
      last = r.proxy.X;
      if (i == ticks + kStill) compare_servo(scene, loop, Y, size, worst);
    }
    from = to;
  }
}

}  // namespace

TEST_CASE("friction, weight, scale and springs of any kind at once: the contacts' sum, in their cones, and rest",
          "[sim][law]") {
  Worst worst;
  for (unsigned seed = 1; seed <= kPockets; ++seed) run(seed, worst);
  std::cout << worst.touching << " of " << worst.ticks << " ticks touch: sum off by " << worst.sum << ", cones by "
            << worst.cone << ", servo at rest by " << worst.servo << " (" << worst.held << " times); at rest moves by "
            << worst.moved << "; " << worst.intersecting << " intersect\n";
  CHECK(worst.touching > worst.ticks / 3);
  CHECK(worst.held > kPockets);
  CHECK(worst.sum < 1e-6);
  CHECK(worst.cone < 1e-7);
  CHECK(worst.servo < 0.01);
  CHECK(worst.intersecting == 0);
  CHECK(worst.moved < 1e-6);
}
