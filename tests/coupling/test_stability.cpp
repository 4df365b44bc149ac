#include <cmath>
#include <limits>

#include "catch.hpp"
#include "coupling/passivity.hpp"
#include "tegotae/coupling/stability.hpp"

using namespace tegotae;

TEST_CASE("the stiffness limit is the smaller of Colgate's and Abbott and Okamura's", "[coupling]") {
  DeviceInfo device;
  device.damping = 2;
  device.torsional_damping = 0.01;
  device.friction = 0.04;
  device.position_resolution = 3e-5;
  // 2 (2 - 1.5) / 1 ms = 1000 N/m; 2 · 0.04 / 3e-5 = 2667 N/m; 2 (0.01 - 0.004) / 1 ms = 12 N·m/rad.
  StabilityReport r = stability(device, {800, 1.5, 0.3, 0.004}, 1000);
  CHECK(r.sampling_limit.value() == Approx(1000));
  CHECK(r.quantization_limit == Approx(0.08 / 3e-5));
  CHECK(r.stiffness_limit.value() == Approx(1000));
  CHECK(r.torsional_stiffness_limit.value() == Approx(12));
  CHECK(r.text().find("above") == std::string::npos);
  // Four times as fast, quantization limits.
  r = stability(device, {3000, 1.5, 0.3, 0.004}, 4000);
  CHECK(r.sampling_limit.value() == Approx(4000));
  CHECK(r.stiffness_limit.value() == Approx(0.08 / 3e-5));
  CHECK(r.text().find("above") != std::string::npos);
  // A coupling that damps more than the device leaves nothing.
  CHECK(stability(device, {800, 5, 0.3, 0.004}, 1000).stiffness_limit.value() == 0);
  device.damping = 0;
  r = stability(device, {800, 5, 0.3, 0.004}, 1000);
  CHECK(!r.stiffness_limit);
  CHECK(r.text().find("not known") != std::string::npos);
}

TEST_CASE("the observer finds the half K Δx² that a sampled spring makes in every tick", "[coupling]") {
  constexpr double K = 1000;
  Passivity passivity({});
  double x = -0.001;
  double generated = 0;
  passivity.observe({}, {}, 0.5 * K * x * x, false, 1e-3);
  for (int i = 0; i < 50; ++i) {
    const Wrench force = {Vec3(-K * x, 0, 0), Vec3::Zero()};
    const double step = 1e-4 * std::sin(0.3 * i);
    x += step;
    generated += 0.5 * K * step * step;
    passivity.observe({Vec3(step, 0, 0), Vec3::Zero()}, force, 0.5 * K * x * x, true, 1e-3);
    REQUIRE(passivity.energy() == Approx(-generated).margin(1e-15));
  }
  // A damper of the device's own that takes out as much.
  PassivitySettings damped;
  damped.device_damping = 0.5 * K * 1e-3;
  Passivity quiet(damped);
  quiet.observe({}, {}, 0.5 * K * 1e-6, false, 1e-3);
  quiet.observe({Vec3(1e-4, 0, 0), Vec3::Zero()}, {Vec3(1, 0, 0), Vec3::Zero()}, 0.5 * K * 0.81e-6, true, 1e-3);
  CHECK(std::abs(quiet.energy()) < 1e-12);
}

TEST_CASE("the controller takes out what was made, against the motion and within its limit", "[coupling]") {
  Passivity passivity({});
  CHECK(passivity.controller(1).force.norm() == 0);
  // 10 µJ given to the hand on a way of 0.1 mm in 1 ms, with a turn of 1 mrad.
  passivity.observe({Vec3(1e-4, 0, 0), Vec3(0, 1e-3, 0)}, {Vec3(0.1, 0, 0), Vec3::Zero()}, 0, true, 1e-3);
  CHECK(passivity.energy() == Approx(-1e-5));
  const double arm2 = 0.01;
  const Wrench w = passivity.controller(arm2);
  const Twist v = {Vec3(0.1, 0, 0), Vec3(0, 1, 0)};
  // The same motion for another tick takes 10 µJ.
  CHECK(-(w.force.dot(v.v) + w.torque.dot(v.w)) * 1e-3 == Approx(1e-5));
  CHECK(w.torque.y() / w.force.x() == Approx(arm2 * 1 / 0.1));
  passivity.observe({Vec3(1e-6, 0, 0), Vec3::Zero()}, {Vec3(100, 0, 0), Vec3::Zero()}, 0, true, 1e-3);
  CHECK(passivity.controller(arm2).force.x() == Approx(-10 * 1e-3));
  passivity.reset();
  CHECK(passivity.controller(arm2).force.norm() == 0);
}

TEST_CASE("a wrench that was cut or faded does not count, and credit is bounded", "[coupling]") {
  Passivity passivity({});
  passivity.observe({Vec3(1, 0, 0), Vec3::Zero()}, {Vec3(8, 0, 0), Vec3::Zero()}, 0, false, 1e-3);
  CHECK(passivity.energy() == 0);
  passivity.observe({Vec3(1, 0, 0), Vec3::Zero()}, {Vec3(-8, 0, 0), Vec3::Zero()}, 0, true, 1e-3);
  CHECK(passivity.energy() == 1e-3);
  const double inf = std::numeric_limits<double>::infinity();
  passivity.observe({Vec3(inf, 0, 0), Vec3::Zero()}, {Vec3(0, 0, 0), Vec3::Zero()}, 0, true, 1e-3);
  CHECK(passivity.energy() == 0);
}
