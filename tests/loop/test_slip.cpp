// A part that slips from a contact to the next one keeps its force on the way: nothing drops out and comes back.
#include <iostream>

#include "bodies.hpp"
#include "catch.hpp"
#include "loop/pen_run.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

/// A block on the upper of two steps, whose edge is at x = 0.
Scene block_on_steps(double size, double drop) {
  Scene scene;
  scene.parts = {{"upper", shared(box(Vec3(0.1, 0.1, 0.02))), {Quat::Identity(), Vec3(-0.05, 0, -0.01)}},
                 {"lower", shared(box(Vec3(0.1, 0.1, 0.02))), {Quat::Identity(), Vec3(0.05, 0, -0.01 - drop)}},
                 {"block",
                  shared(box(Vec3::Constant(size))),
                  {Quat::Identity(), Vec3(-0.5 * size - 2e-3, 0, 0.5 * size + 1e-3)},
                  true}};
  scene.contact.tick_budget = INFINITY;
  scene.max_torsional_stiffness = kMaxTorsional;
  return scene;
}

/// Presses the block on the upper step, pushes it over the edge and along the lower one.
StylusScript over_the_edge(const Pose& from, double size, double depth) {
  const auto at = [&](double x, double z) { return Pose{from.q, from.p + Vec3(x, 0, z)}; };
  const double down = -1e-3 - depth, over = size + 6e-3;
  return StylusScript(
      {{0, from}, {0.4, from}, {0.9, at(0, down)}, {1.2, at(0, down)}, {2.7, at(over, down)}, {3, at(over, down)}});
}

}  // namespace

TEST_CASE("a part that slips over an edge never loses its force", "[law]") {
  const double size = GENERATE(0.006, 0.012, 0.03);
  const double drop = GENERATE(0.5e-3, 1e-3, 2e-3);
  const Scene scene = block_on_steps(size, drop);
  const double depth = 9e-3;  // 2.4 N on the upper step: the springs are longer than the way down
  const StylusScript script = over_the_edge(scene.parts.back().pose, size, depth);
  PenRun hand(scene, script);
  bool pressed = false;
  double least = 1e9;
  int damped = 0;
  for (int i = 0; 1e-3 * i < script.end() + 0.2; ++i) {
    const PenSample pen = hand.tick();
    damped += (pen.flags & TEGOTAE_SHM_FLAG_DAMPED) != 0 ? 1 : 0;
    const double force = pen.wrench.force.norm();
    pressed = pressed || force > 1;
    if (pressed) least = std::min(least, force);
  }
  CAPTURE(size, drop);
  std::cout << "block of " << 1e3 * size << " mm, step of " << 1e3 * drop << " mm: at least " << least << " N\n";
  CHECK(pressed);
  CHECK(hand.loop.latest().p.z() < 0.5 * size - 0.5 * drop);  // it is down
  CHECK(least > 0.1);
  CHECK(damped == 0);
}
