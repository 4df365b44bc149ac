// Why a part lags behind the pen: the rule, its count, and loops that are held back for each reason.
#include "bodies.hpp"
#include "catch.hpp"
#include "loop/lag.hpp"
#include "models/shapes.hpp"
#include "stress_run.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr double kBound = 3e-4;

TickEnd lagging(double lag) {
  TickEnd end;
  end.lag = lag;
  end.bound = kBound;
  end.allowed = lag;
  return end;
}

/// A cube of 20 mm that hovers 5 mm over a floor; radius 17 mm.
Scene cube_over_floor() {
  Scene scene;
  scene.parts.push_back({"floor", shared(shapes::box({0.1, 0.1, 0.02})), {Quat::Identity(), {0, 0, -0.01}}, false});
  scene.parts.push_back({"cube", shared(box({0.02, 0.02, 0.02})), {Quat::Identity(), {0, 0, 0.015}}, true});
  scene.contact.tick_budget = INFINITY;
  return scene;
}

Pose at_height(double z) {
  return {Quat::Identity(), {0, 0, z}};
}

}  // namespace

TEST_CASE("a contact explains a lag only when it stands in its way", "[lag]") {
  CHECK(lag_reason(lagging(0)) == LagReason::none);
  TickEnd end = lagging(0.001);
  CHECK(lag_reason(end) == LagReason::capacity);
  end.moved = true;
  CHECK(lag_reason(end) == LagReason::time);
  end.moved = false;
  end.late = true;
  CHECK(lag_reason(end) == LagReason::time);
  // On a floor, late along it: the program allows the whole way.
  end.contacts = 4;
  CHECK(lag_reason(end) == LagReason::time);
  end.late = false;
  CHECK(lag_reason(end) == LagReason::capacity);
  // Pressed by a millimeter, late along the floor by less than anyone needs to know, and by more.
  end.allowed = 0.9 * kBound;
  CHECK(lag_reason(end) == LagReason::contact);
  end.allowed = 1.1 * kBound;
  CHECK(lag_reason(end) == LagReason::capacity);
  end.held_by_contacts = true;
  CHECK(lag_reason(end) == LagReason::contact);
  // The same without a contact: something else limits the motion.
  end.contacts = 0;
  CHECK(lag_reason(end) == LagReason::capacity);
  // Most of a small lag would go away if the motion were made.
  end = lagging(0.1 * kBound);
  end.contacts = 1;
  end.moved = true;
  CHECK(lag_reason(end) == LagReason::time);
}

TEST_CASE("lags without a contact count from the twenty-first tick in a row on", "[lag]") {
  LagCounter counter;
  const auto add = [&counter](int ticks, double lag, LagReason reason, double moved = 0.9 * kBound) {
    for (int i = 0; i < ticks; ++i) counter.add(lag, moved, kBound, reason);
  };
  add(20, 2 * kBound, LagReason::time);
  CHECK(counter.ticks() == 0);
  add(1, 2 * kBound, LagReason::contact);
  add(20, 2 * kBound, LagReason::capacity);
  add(1, 0.5 * kBound, LagReason::capacity);
  add(10, 2 * kBound, LagReason::suspended);
  add(10, 2 * kBound, LagReason::capacity);
  CHECK(counter.ticks() == 0);
  add(3, 2 * kBound, LagReason::time);
  CHECK(counter.ticks() == 3);
  add(100, 2 * kBound, LagReason::contact);
  add(25, 2 * kBound, LagReason::time);
  CHECK(counter.ticks() == 8);
  // On its way to a pen that jumped.
  add(100, 100 * kBound, LagReason::time, 1.1 * kBound);
  add(20, 2 * kBound, LagReason::time);
  CHECK(counter.ticks() == 8);
}

TEST_CASE("the bound is 0.3 mm, and one percent of a small part's radius", "[lag]") {
  CHECK(lag_bound(1.0) == 3e-4);
  CHECK(lag_bound(0.03) == 3e-4);
  CHECK(lag_bound(0.001) == Approx(1e-5));
}

TEST_CASE("a free part has no lag, and one that is pressed on a floor lags for contact", "[lag]") {
  HapticLoop loop(cube_over_floor());
  for (int i = 0; i < 100; ++i) {
    const double z = 0.015 - 1e-4 * i;
    const TickReport& tick = loop.step(at_height(z), 0.001);
    if (z > 0.0102) {
      CHECK(tick.lag == 0);
      CHECK(tick.lag_reason == LagReason::none);
      CHECK_FALSE(tick.proxy.touching);
    } else if (z < 0.0098) {
      CHECK(tick.lag == Approx(0.01 - z).margin(2e-5));
      CHECK(tick.lag_reason == LagReason::contact);
      CHECK(tick.proxy.touching);
    }
  }
  CHECK(loop.report().unexplained_lag_ticks == 0);
}

TEST_CASE("the lag of a turned pen is the radius times its angle", "[lag]") {
  HapticLoop loop(cube_over_floor());
  for (int i = 0; i < 200; ++i) loop.step(at_height(0.009), 0.001);
  // Tilted about x the cube would go into the floor with an edge; it lies there, so nearly all of the turn is left.
  const double angle = 0.02, radius = std::sqrt(3.0) * 0.01;
  const TickReport& tick = loop.step({rotation({angle, 0, 0}), {0, 0, 0.009}}, 0.001);
  const Pose& X = tick.proxy.X;
  const double left = rotation({angle, 0, 0}).angularDistance(X.q);
  CHECK(tick.lag == Approx((X.p - Vec3(0, 0, 0.009)).norm() + radius * left).epsilon(1e-6));
}

TEST_CASE("a loop without time is late, says so, and the hand feels it", "[lag]") {
  Scene scene = cube_over_floor();
  scene.contact.tick_budget = 1e-9;
  // So near to the floor that a motion along it has to be looked at.
  scene.parts.back().pose.p.z() = 0.0102;
  HapticLoop loop(scene);
  for (int i = 0; i < 60; ++i) {
    const TickReport& tick = loop.step({Quat::Identity(), {1e-4 * std::min(i, 40), 0, 0.0102}}, 0.001);
    if (i < 10) continue;
    CHECK(tick.lag > 5e-4);
    CHECK(tick.lag_reason == LagReason::time);
    CHECK(tick.proxy.touching);
    CHECK(tick.contacts == 0);
  }
  // Over its bound of 0.17 mm from the third tick on.
  CHECK(loop.lag_bound() == Approx(3e-4 * std::sqrt(3.0) / 3));
  CHECK(loop.report().unexplained_lag_ticks == 60 - 2 - kLagPatience);
}

TEST_CASE("a pen that is not followed is said not to be", "[lag]") {
  HapticLoop loop(cube_over_floor());
  loop.step(at_height(0.014), 0.001);
  const TickReport& tick = loop.step({Quat::Identity(), {NAN, 0, 0}}, 0.001);
  CHECK(tick.lag_reason == LagReason::suspended);
  CHECK(tick.proxy.velocity.v.isZero());
  CHECK(tick.substeps.size() == 1);
  CHECK(loop.step(at_height(0.014), 0.001).lag_reason == LagReason::none);
}

TEST_CASE("a peg that is pulled through its hole from afar is not held by play and friction", "[lag][friction]") {
  // The pen stands 10 mm further and to the side; the first motion that obeys friction's convex neighbor is the play
  // over mu a tick.
  StressOptions options;
  options.mu = 0.64;
  LatencyHistogram cpu;
  const StressResult run = run_stress_script(stress_scene("peg_0.99", 138), 138, options, cpu);
  CHECK(run.ticks == options.ticks);
  CHECK(run.touching > 0);
  CHECK(run.intersecting == 0);
  CHECK(run.unexplained == 0);
}
