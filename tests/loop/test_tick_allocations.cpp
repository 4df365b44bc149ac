// A warmed-up tick neither allocates nor frees.
#include <cmath>

#include "alloc_guard.hpp"
#include "bodies.hpp"
#include "catch.hpp"
#include "models/shapes.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

/// Down onto the rim, tilted into the hole, jammed, fast, jumping away and back, and out again.
Pose pen(int tick) {
  const double t = 1e-3 * tick;
  const double depth = 0.03 * (1 - std::cos(2 * M_PI * t / 0.6)) / 2;
  Pose Y{rotation({0.1 * std::sin(37 * t), 0.1 * std::cos(29 * t) - 0.1, 0.3 * t}),
         {0.003 * std::sin(23 * t), 0.003 * std::sin(31 * t), 0.026 - depth}};
  if (tick % 97 == 50) Y.p += Vec3(0.05, 0.01, 0.02);
  return Y;
}

}  // namespace

TEST_CASE("a warmed-up tick does not allocate", "[allocation]") {
  const std::string resolver = GENERATE("lp", "qp", "impulse", "penalty");
  const std::string narrowphase = "patch";
  CAPTURE(resolver);
  Scene scene;
  scene.contact.resolver = resolver_kind(resolver);
  scene.contact.narrowphase = narrowphase == "fcl" ? NarrowPhase::fcl : NarrowPhase::patch;
  scene.contact.tick_budget = INFINITY;
  shapes::Peg peg;
  peg.diameter = 0.0198;
  scene.parts.push_back({"hole", shared(shapes::block_with_hole({})), Pose{}, false});
  std::mt19937 rng(9);
  scene.parts.push_back({"star", shared(random_star_body(rng, 14, 0.01)), {Quat::Identity(), {0.02, 0, 0.01}}, false});
  scene.parts.push_back({"peg", shared(shapes::peg(peg)), {Quat::Identity(), {0, 0, 0.026}}, true});
  HapticLoop loop(scene);
  constexpr int kTicks = 1200;
  for (int tick = 0; tick < kTicks; ++tick) loop.step(pen(tick), 1e-3);
  int touching = 0;
  std::uint64_t allocations = 0;
  int first = -1;
  for (int tick = 0; tick < kTicks; ++tick) {
    const Pose Y = pen(tick);
    const AllocGuard guard;
    const TickReport& r = loop.step(Y, 1e-3);
    allocations += guard.count();
    if (guard.count() > 0 && first < 0) first = tick;
    touching += r.proxy.touching;
  }
  CAPTURE(first);
  CHECK(allocations == 0);
  REQUIRE(touching > kTicks / 3);
}

TEST_CASE("a tick does not allocate while pairs of the start come free", "[allocation]") {
  const std::string resolver = GENERATE("lp", "qp", "impulse", "penalty");
  CAPTURE(resolver);
  Scene scene;
  scene.contact.resolver = resolver_kind(resolver);
  scene.contact.tick_budget = INFINITY;
  scene.contact.initial_overlap = InitialOverlap::ignore;
  // Pressed between two walls, over a floor, and drawn into a post.
  for (const double side : {-1.0, 1.0})
    scene.parts.push_back(
        {side > 0 ? "right" : "left", shared(box({0.02, 0.04, 0.02})), {Quat::Identity(), {side * 0.014999, 0, 0.01}}});
  scene.parts.push_back({"floor", shared(box({0.1, 0.1, 0.02})), {Quat::Identity(), {0, 0, -0.01}}});
  scene.parts.push_back({"post", shared(box({0.004, 0.004, 0.004})), {Quat::Identity(), {0, 0.006, 0.005}}});
  scene.parts.push_back({"block", shared(box({0.01, 0.01, 0.01})), {Quat::Identity(), {0, 0, 0.005}}, true});
  HapticLoop loop(scene);
  CHECK(loop.report().filtered == 1);
  CHECK(loop.report().shrunk == (resolver == "penalty" ? 0 : 2));
  const auto pen_at = [](int tick) {
    return Pose{Quat::Identity(), {0, 0, 0.005 + 0.015 * (1 - std::cos(0.02 * tick))}};
  };
  for (int tick = 0; tick < 10; ++tick) loop.step(pen_at(0), 1e-3);
  std::uint64_t allocations = 0;
  for (int tick = 0; tick < 300; ++tick) {
    const Pose Y = pen_at(tick);
    const AllocGuard guard;
    loop.step(Y, 1e-3);
    allocations += guard.count();
  }
  CHECK(allocations == 0);
  CHECK(loop.report().filtered == 0);
  CHECK(loop.report().shrunk == 0);
}
