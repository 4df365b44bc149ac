#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <thread>

#include "bodies.hpp"
#include "catch.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/device/simulated_device.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr double kTick = 1e-3;

StylusScript still(const Pose& pose = Pose()) {
  return StylusScript({{0, pose}});
}

void settle(SimulatedDevice& device, double seconds) {
  for (double t = 0; t < seconds; t += kTick) device.advance(kTick);
}

}  // namespace

TEST_CASE("the hand gives way to a constant wrench as its springs say", "[device]") {
  std::mt19937 rng(2);
  for (int i = 0; i < 5; ++i) {
    const Pose pose{rotation(random_vector(rng, 1)), random_vector(rng, 0.3)};
    const Vec3 center = random_vector(rng, 0.05);
    SimulatedDeviceSettings s;
    s.friction = 0;
    SimulatedDevice device(s, still(pose), center);
    device.start();
    const Wrench wrench{random_vector(rng, 3), random_vector(rng, 0.1)};
    device.write(wrench);
    settle(device, 3);
    const Pose now = device.true_pose();
    CHECK((now * center - pose * center - wrench.force / s.hand.stiffness).norm() < 1e-9);
    const Mat3 turn = (now.q * pose.q.conjugate()).toRotationMatrix();
    const Vec3 angle = wrench.torque / s.hand.torsional_stiffness;
    CHECK((turn - Eigen::AngleAxisd(angle.norm(), angle.normalized()).toRotationMatrix()).norm() < 1e-9);
  }
}

TEST_CASE("no more than the limits is rendered, in the direction asked for", "[device]") {
  SimulatedDeviceSettings s;
  s.friction = 0;
  SimulatedDevice device(s, still());
  device.start();
  device.write({Vec3(300, 0, -400), Vec3(0, 1, 0)});
  settle(device, 3);
  CHECK((device.true_pose().p - Vec3(0.6, 0, -0.8) * 8.5 / 400).norm() < 1e-9);
  // Scaled by 8.5/500 as a whole.
  CHECK((rotation_vector(device.true_pose().q) - Vec3(0, 8.5 / 500 / 1.5, 0)).norm() < 1e-9);
  device.write({Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0), Vec3::Zero()});
  settle(device, 3);
  CHECK(device.true_pose().p.norm() < 1e-9);
  device.write({Vec3(5, 0, 0), Vec3::Zero()});
  device.stop();
  settle(device, 3);
  CHECK(device.true_pose().p.norm() < 1e-9);
}

TEST_CASE("force and torque are saturated together", "[device]") {
  const WrenchLimits limits{8, 0.2};
  const Wrench inside = saturated({Vec3(3, 4, 0), Vec3(0.1, 0, 0)}, limits);
  CHECK(inside.force == Vec3(3, 4, 0));
  CHECK(inside.torque == Vec3(0.1, 0, 0));
  const Wrench force = saturated({Vec3(0, 16, 0), Vec3(0.1, 0, 0)}, limits);
  CHECK((force.force - Vec3(0, 8, 0)).norm() < 1e-15);
  CHECK((force.torque - Vec3(0.05, 0, 0)).norm() < 1e-15);
  const Wrench torque = saturated({Vec3(0, 16, 0), Vec3(2, 0, 0)}, limits);
  CHECK((torque.force - Vec3(0, 1.6, 0)).norm() < 1e-15);
  CHECK((torque.torque - Vec3(0.2, 0, 0)).norm() < 1e-15);
  const Wrench huge = saturated({Vec3(1e300, 1e300, 0), Vec3::Zero()}, limits);
  CHECK(huge.force.norm() == Approx(8));
  CHECK(saturated({Vec3(1, 2, 3), Vec3(0, INFINITY, 0)}, limits).force.norm() == 0);
}

TEST_CASE("the pen follows the hand, and rests within the friction's dead zone", "[device]") {
  // 0.1 m/s along a diagonal while turning at 0.5 rad/s, then a rest; the center of mass is 0.1 m off the file frame.
  const Vec3 center(0, 0.1, 0);
  const Pose end{Quat(Eigen::AngleAxisd(0.5, Vec3::UnitX())), 0.1 * Vec3(0.6, 0, 0.8)};
  const StylusScript script({{0, Pose()}, {1, end}, {2, end}});
  SimulatedDevice device({}, script, center);
  device.start();
  double worst = 0;
  double worst_angle = 0;
  for (int i = 1; i <= 1000; ++i) {
    device.advance(kTick);
    const Pose wanted = script.pose(i * kTick);
    const DeviceState seen = device.read();
    if (i > 300) worst = std::max(worst, (seen.pose * center - wanted * center).norm());
    worst_angle = std::max(worst_angle, rotation_vector(wanted.q * seen.pose.q.conjugate()).norm());
  }
  // Once it has sped up only friction (0.04 N on 400 N/m), the path's curvature and the encoder are left.
  CHECK(worst < 2e-4);
  CHECK(worst_angle < 0.01);
  settle(device, 1);
  CHECK((device.true_pose() * center - end * center).norm() <= 0.04 / 400 + 1e-9);
  CHECK(device.true_velocity().v.norm() == 0);
  CHECK(rotation_vector(device.true_pose().q * end.q.conjugate()).norm() < 1e-9);
}

TEST_CASE("speeding up to 0.1 m/s at once, the pen lags by less than 2 mm", "[device]") {
  const StylusScript script({{0, Pose()}, {1, {Quat::Identity(), Vec3(0.1, 0, 0)}}});
  SimulatedDevice device({}, script);
  device.start();
  for (int i = 1; i <= 1000; ++i) {
    device.advance(kTick);
    REQUIRE((device.read().pose.p - script.pose(i * kTick).p).norm() < 2e-3);
  }
}

TEST_CASE("poses are as coarse as the encoders and the velocity is still useful", "[device]") {
  const Vec3 center(0.01, 0.02, -0.03);
  const Pose end{Quat(Eigen::AngleAxisd(1.0, Vec3(1, 2, 2) / 3)), Vec3(0.1, -0.05, 0.02)};
  const StylusScript script({{0, Pose()}, {1, end}});
  SimulatedDeviceSettings s;
  SimulatedDevice device(s, script, center);
  device.start();
  double square_v = 0;
  int counted = 0;
  for (int i = 1; i <= 1000; ++i) {
    device.advance(kTick);
    const DeviceState seen = device.read();
    REQUIRE(seen.sequence == static_cast<std::uint64_t>(i - 1));
    REQUIRE(seen.time_ns == i * 1'000'000);
    const Vec3 point = seen.pose * center;
    const Vec3 steps = point / 3e-5;
    REQUIRE((steps.array() - steps.array().round()).abs().maxCoeff() < 1e-6);
    REQUIRE((point - device.true_pose() * center).cwiseAbs().maxCoeff() <= 1.5e-5 + 1e-12);
    // Each component of the rotation vector by half a step, and the map to rotations is not an expansion.
    REQUIRE(rotation_vector(seen.pose.q * device.true_pose().q.conjugate()).norm() <= 0.5e-4 * std::sqrt(3.0) + 1e-12);
    if (i > 100) {
      square_v += (seen.velocity.v - device.true_velocity().v).squaredNorm();
      ++counted;
    }
  }
  CHECK(std::sqrt(square_v / counted) < 0.01);  // of about 0.12 m/s
}

TEST_CASE("the same calls give the same bits", "[device]") {
  const auto run = [] {
    const StylusScript script({{0, Pose()}, {0.5, {rotation(Vec3(0.3, 0.2, 0.1)), Vec3(0.05, 0, 0.02)}}});
    SimulatedDevice device({}, script, Vec3(0.01, 0, 0));
    device.start();
    std::vector<double> trace;
    for (int i = 0; i < 1000; ++i) {
      device.advance(kTick);
      const DeviceState s = device.read();
      device.write({-300 * s.pose.p - 3 * s.velocity.v, -0.2 * s.velocity.w});
      for (int k = 0; k < 3; ++k) {
        trace.push_back(s.pose.p[k]);
        trace.push_back(s.velocity.v[k]);
        trace.push_back(s.velocity.w[k]);
      }
      for (int k = 0; k < 4; ++k) trace.push_back(s.pose.q.coeffs()[k]);
    }
    return trace;
  };
  const std::vector<double> a = run();
  const std::vector<double> b = run();
  CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

TEST_CASE("a virtual wall of 2000 N/m at 1 kHz comes to rest in the hand", "[device]") {
  // The hand wants to be 10 mm inside the wall x >= 0.
  const StylusScript script({{0, {Quat::Identity(), Vec3(0.02, 0, 0)}}, {0.3, {Quat::Identity(), Vec3(-0.01, 0, 0)}}});
  SimulatedDevice device({}, script);
  device.start();
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (int i = 0; i < 3000; ++i) {
    device.advance(kTick);
    const double x = device.read().pose.p.x();
    device.write({Vec3(x < 0 ? -2000 * x : 0, 0, 0), Vec3::Zero()});
    if (i < 2500) continue;
    low = std::min(low, device.true_pose().p.x());
    high = std::max(high, device.true_pose().p.x());
  }
  CHECK(high - low < 3e-5);  // one step of the encoder
  // Balance 2000 x = 400 (-0.01 - x), the friction's dead zone and the encoder's step apart.
  CHECK(std::abs(low + 0.01 * 400 / 2400) < 0.04 / 2400 + 3e-5);
}

TEST_CASE("another center of mass is another point of the same moving body", "[device]") {
  const StylusScript script({{0, Pose()}, {1, {rotation(Vec3(0, 0, 1)), Vec3(0.1, 0, 0)}}});
  SimulatedDevice device({}, script);
  device.start();
  for (int i = 0; i < 200; ++i) device.advance(kTick);
  const Pose pose = device.true_pose();
  const Twist before = device.true_velocity();
  const Vec3 center(0.03, -0.02, 0.05);
  device.set_held_center(center);
  CHECK(device.reference_point() == center);
  CHECK((device.true_pose().p - pose.p).norm() < 1e-15);
  CHECK(device.true_pose().q.coeffs() == pose.q.coeffs());
  CHECK((device.true_velocity().v - before.v - before.w.cross(pose.q * center)).norm() < 1e-15);
  CHECK((device.true_velocity().w - before.w).norm() == 0);
}

TEST_CASE("by the wall clock it moves by the time between two reads", "[device]") {
  SimulatedDeviceSettings s;
  s.wall_clock = true;
  SimulatedDevice device(s, still());
  device.start();
  const DeviceState first = device.read();
  CHECK(device.script_time() == 0);
  std::int64_t expected = 0;
  std::int64_t last = first.time_ns;
  for (int pause_ms : {1, 3, 120}) {
    std::this_thread::sleep_for(std::chrono::milliseconds(pause_ms));
    const std::int64_t now = device.read().time_ns;
    expected += std::min<std::int64_t>(now - last, 50'000'000);
    last = now;
    CHECK(device.script_time() == Approx(1e-9 * static_cast<double>(expected)).epsilon(1e-12));
  }
}

TEST_CASE("settings out of range are refused by name", "[device]") {
  SimulatedDeviceSettings s;
  s.mass = 0;
  CHECK_THROWS_WITH(SimulatedDevice(s, still()), Catch::Contains("mass"));
  s = {};
  s.hand.damping = -1;
  CHECK_THROWS_WITH(SimulatedDevice(s, still()), Catch::Contains("hand damping"));
  s = {};
  s.hand.stiffness = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(SimulatedDevice(s, still()), Catch::Contains("hand stiffness"));
  CHECK_THROWS_WITH(SimulatedDevice({}, still(), Vec3(0, INFINITY, 0)), Catch::Contains("center"));
}

TEST_CASE("states and reasons can be told to people", "[device]") {
  SimulatedDevice device({}, still());
  CHECK(device.status() == DeviceStatus::uninitialized);
  CHECK(device.reason() == ForceOff::software);
  device.start();
  CHECK(device.status() == DeviceStatus::enabled);
  CHECK(device.reason() == ForceOff::none);
  CHECK(std::string(to_string(ForceOff::watchdog)) == "the contact loop's heartbeat is too old");
  CHECK(std::string(to_string(static_cast<ForceOff>(77))) == "unknown reason");
  CHECK(std::string(to_string(DeviceStatus::ready)) == "ready, force off");
}
