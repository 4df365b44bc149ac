#include <cmath>
#include <limits>
#include <random>

#include "catch.hpp"
#include "core/valid_pose.hpp"
#include "servo/puppet_device.hpp"
#include "servo/safety_links.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

using Limits = std::numeric_limits<std::int64_t>;

Wrench force(double x) {
  return {Vec3(x, 0, 0), Vec3::Zero()};
}

}  // namespace

TEST_CASE("times of garbage are apart", "[servo]") {
  CHECK(within(5, 3, 2));
  CHECK(within(3, 5, 2));
  CHECK_FALSE(within(6, 3, 2));
  CHECK_FALSE(within(Limits::max(), Limits::min(), Limits::max()));
  CHECK_FALSE(within(Limits::min(), 1, 100));
}

TEST_CASE("a pose is valid when it is finite and its quaternion has length one", "[servo]") {
  CHECK(is_valid(Pose()));
  Pose bad;
  bad.q.coeffs() *= 1.01;
  CHECK_FALSE(is_valid(bad));
  bad = Pose();
  bad.q.coeffs()[2] = std::nan("");
  CHECK_FALSE(is_valid(bad));
  bad = Pose();
  bad.p.y() = std::numeric_limits<double>::infinity();
  CHECK_FALSE(is_valid(bad));
  bad.p.y() = -2 * kFarthest;
  CHECK_FALSE(is_valid(bad));
}

TEST_CASE("the force fades over the margin of the workspace", "[servo]") {
  SafetySettings s;
  CHECK(workspace_gain(s, Vec3(1e6, 0, 0)) == 1);
  s.workspace_center = Vec3(0.1, 0, 0);
  s.workspace_half = Vec3(0.1, 0.2, 0.3);
  s.workspace_margin = 0.02;
  CHECK(workspace_gain(s, Vec3(0.2, -0.2, 0.3)) == 1);
  CHECK(workspace_gain(s, Vec3(0.205, 0, 0)) == Approx(0.75));
  // 3-4-5: 3 mm out in x and 4 mm out in y are 5 mm out.
  CHECK(workspace_gain(s, Vec3(-0.003, 0.204, 0)) == Approx(0.75));
  CHECK(workspace_gain(s, Vec3(0, 0, -0.33)) == 0);
  for (int k = 0; k < 3; ++k) CHECK(workspace_gain(s, Vec3::Unit(k) * std::nan("")) == 0);
}

TEST_CASE("a wrench changes by at most the slew limit, on the straight way to where it should be", "[servo]") {
  SlewLimit slew({1000, 20});
  // 1 N a tick of 1 ms.
  for (int i = 1; i <= 5; ++i) CHECK(slew.apply({Vec3(3, 4, 0), Vec3::Zero()}, kTick).force.norm() == Approx(i));
  CHECK(slew.apply({Vec3(3, 4, 0), Vec3::Zero()}, kTick).force == Vec3(3, 4, 0));
  // The torque needs five ticks of 0.02 N·m; the force waits for it.
  for (int i = 1; i <= 5; ++i) {
    const Wrench w = slew.apply({Vec3(3, 4, 1), Vec3(0, 0.1, 0)}, kTick);
    CHECK(w.torque.y() == Approx(0.02 * i));
    CHECK(w.force.z() == Approx(0.2 * i));
  }
  CHECK(slew.apply(force(100), 0).force.z() == 1);
  slew.reset();
  CHECK(slew.last().force.norm() == 0);
}

TEST_CASE("the running RMS settles at the continuous figure and never passes it", "[servo]") {
  SafetySettings s;
  s.thermal_time = 2;
  for (double wanted : {1.0, 1.5, 3.0, 8.5}) {
    ThermalBudget budget(s);
    CHECK(budget.allowed() == Approx(8.5));
    double last = 8.5;
    double squares = 0;
    for (int i = 0; i < 40'000; ++i) {
      const double rendered = std::min(wanted, budget.allowed());
      budget.add(rendered, kTick);
      REQUIRE(budget.load() <= 1 + 1e-12);
      // Smoothly: no step of more than what the fastest warming makes of the peak in a tick.
      REQUIRE(std::abs(budget.allowed() - last) < 0.1);
      last = budget.allowed();
      if (i >= 30'000) squares += rendered * rendered * 1e-4;
    }
    CHECK(std::sqrt(squares) == Approx(std::min(wanted, 1.4)).epsilon(1e-3));
  }
}

TEST_CASE("a pulsing force has the continuous figure as its RMS over the time constant", "[servo]") {
  SafetySettings s;
  s.thermal_time = 2;
  ThermalBudget budget(s);
  double squares = 0;
  constexpr int kTicks = 60'000;
  for (int i = 0; i < kTicks; ++i) {
    const double rendered = i % 1000 < 300 ? std::min(8.5, budget.allowed()) : 0;
    budget.add(rendered, kTick);
    if (i >= kTicks / 2) squares += rendered * rendered * 2 / kTicks;
  }
  CHECK(std::sqrt(squares) < 1.4);
  CHECK(std::sqrt(squares) > 1.2);
}

TEST_CASE("motors without a thermal limit are never held back", "[servo]") {
  SafetySettings s;
  s.continuous_force = 0;
  ThermalBudget budget(s);
  for (int i = 0; i < 1000; ++i) budget.add(8.5, 1);
  CHECK(budget.allowed() == 8.5);
  CHECK(budget.load() == 0);
}

TEST_CASE("the gate engages from a small force only, ramps in, and fades all the way", "[servo]") {
  ForceGate gate({});  // engages after 10 ms under 0.2 N, ramps over 200 ms, fades over 3 ms
  for (int i = 0; i < 100; ++i) REQUIRE(gate.update(ForceOff::none, force(3), kTick) == 0);
  CHECK(gate.reason() == ForceOff::engage);
  for (int i = 0; i < 8; ++i) REQUIRE(gate.update(ForceOff::none, force(0.1), kTick) == 0);
  gate.update(ForceOff::none, force(0.3), kTick);  // not small: waits anew
  int ticks = 0;
  while (gate.reason() == ForceOff::engage && ticks < 100) {
    gate.update(ForceOff::none, force(0.1), kTick);
    ++ticks;
  }
  CHECK(ticks >= 10);
  CHECK(ticks <= 11);
  for (int i = 1; i <= 100; ++i)
    REQUIRE(gate.update(ForceOff::none, force(8), kTick) == Approx(0.005 * i).margin(1e-12));
  for (int i = 0; i < 110; ++i) gate.update(ForceOff::none, force(8), kTick);
  CHECK(gate.gain() == 1);
  // The cause goes away at once; the fade does not.
  CHECK(gate.update(ForceOff::velocity, force(8), kTick) == Approx(2.0 / 3));
  CHECK(gate.update(ForceOff::none, force(8), kTick) == Approx(1.0 / 3));
  CHECK(gate.reason() == ForceOff::velocity);
  CHECK(gate.update(ForceOff::none, force(8), kTick) == 0);
  CHECK(gate.reason() == ForceOff::velocity);
  gate.update(ForceOff::none, force(8), kTick);
  CHECK(gate.reason() == ForceOff::engage);
  gate.update(ForceOff::watchdog, force(0), kTick);
  CHECK(gate.reason() == ForceOff::watchdog);
}

TEST_CASE("a cut is at once, and small torques are asked for too", "[servo]") {
  ForceGate gate({});
  for (int i = 0; i < 300; ++i) gate.update(ForceOff::none, force(0), kTick);
  CHECK(gate.gain() == 1);
  gate.shut_off(ForceOff::not_finite);
  CHECK(gate.gain() == 0);
  CHECK(gate.reason() == ForceOff::not_finite);
  for (int i = 0; i < 300; ++i) gate.update(ForceOff::none, {Vec3::Zero(), Vec3(0, 0.1, 0)}, kTick);
  CHECK(gate.reason() == ForceOff::engage);
}

TEST_CASE("a pen without new samples is silent, for 10 s too", "[servo]") {
  PenWatch watch({});
  DeviceState pen;
  watch.update(pen, {}, 0);
  for (std::int64_t t = 0; t <= 20; ++t) {
    watch.update(pen, {}, t * kMs);
    REQUIRE_FALSE(watch.silent());
  }
  for (std::int64_t t = 21; t <= 10'000; ++t) {
    watch.update(pen, {}, t * kMs);
    REQUIRE(watch.silent());
  }
  pen.sequence = 1;
  watch.update(pen, {}, 10'001 * kMs);
  CHECK_FALSE(watch.silent());
}

TEST_CASE("a pen is too fast by what it says and by how far it came", "[servo]") {
  PenWatch watch({});  // 2 m/s, 50 rad/s
  DeviceState pen;
  const auto next = [&](const Twist& velocity, const Displacement& moved) {
    ++pen.sequence;
    pen.time_ns += kMs;
    pen.velocity = velocity;
    watch.update(pen, moved, pen.time_ns);
    return watch.fast();
  };
  CHECK_FALSE(next({}, {Vec3(1, 0, 0), Vec3::Zero()}));  // the first sample came from nowhere
  CHECK_FALSE(next({Vec3(1.2, 1.5, 0), Vec3(0, 49, 0)}, {Vec3(0.0019, 0, 0), Vec3(0, 0, 0.049)}));
  CHECK(next({Vec3(1.3, 1.6, 0), Vec3::Zero()}, {}));
  CHECK(next({Vec3::Zero(), Vec3(0, 51, 0)}, {}));
  CHECK(next({}, {Vec3(0, 0.0021, 0), Vec3::Zero()}));
  CHECK(next({}, {Vec3::Zero(), Vec3(0, 0.051, 0)}));
  CHECK_FALSE(next({}, {}));
  CHECK(next({Vec3(std::nan(""), 0, 0), Vec3::Zero()}, {}));
}
