#include <Eigen/Eigenvalues>
#include <complex>
#include <vector>

#include "catch.hpp"
#include "puppet_device.hpp"
#include "servo/puppet_device.hpp"
#include "tegotae/coupling/stability.hpp"
#include "tegotae/device/simulated_device.hpp"

using namespace tegotae;
using namespace tegotae::test;
using test::kMs;

namespace {

// A hand with little damping: 2 b / T = 2000 N/m.
constexpr double kDamping = 1.0;
constexpr double kBound = 2 * kDamping / kTick;

SimulatedDeviceSettings loose_hand() {
  SimulatedDeviceSettings s;
  s.hand.stiffness = 100;
  s.hand.damping = kDamping;
  s.friction = 0;
  s.position_resolution = 0;
  s.rotation_resolution = 0;
  return s;
}

/// Largest growth of a tick of m x'' = -k x - b x' + u, u = -K x held over the tick: the largest eigenvalue of the
/// exactly discretized system. The matrix exponential by its series.
double growth(double mass, double k, double b, double K) {
  Eigen::Matrix3d system = Eigen::Matrix3d::Zero();  // of (x, x', u)
  system(0, 1) = 1;
  system.row(1) << -k / mass, -b / mass, 1 / mass;
  Eigen::Matrix3d exponential = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d term = exponential;
  for (int i = 1; i < 30; ++i) {
    term = (term * system * kTick / i).eval();
    exponential += term;
  }
  Eigen::Matrix2d closed = exponential.topLeftCorner<2, 2>();
  closed.col(0) -= K * exponential.topRightCorner<2, 1>();
  return closed.eigenvalues().cwiseAbs().maxCoeff();
}

/// Energy-like size of the swing between two readings.
struct Swing {
  double low = 1e9, high = -1e9;
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  double size() const { return high - low; }
};

struct WallRun {
  Swing end;         // of the last half second, m
  bool off = false;  // the force went off as unstable
  bool damped = false;
};

/// The hand presses 20 mm into the wall x >= 0 of stiffness K, through the whole servo, for 10 s.
WallRun press_wall(double K, const SafetySettings& safety) {
  const Vec3 out(0.002, 0, 0);
  const Vec3 in(-0.02, 0, 0);
  const StylusScript script(
      {{0, {Quat::Identity(), out}}, {0.3, {Quat::Identity(), out}}, {0.6, {Quat::Identity(), in}}});
  SimulatedDevice device(loose_hand(), script);
  device.start();
  Channel channel = Channel::create();
  ContactLink link(channel, {K, 0, 0.3, 0.004}, Vec3::Zero());
  ServoSettings settings;
  settings.safety = safety;
  Servo servo(device, channel, settings);
  WallRun run;
  for (int i = 0; i < 10'000; ++i) {
    servo.tick(i * kMs);
    PenSample pen;
    REQUIRE(link.read(pen));
    ProxyState x;
    x.X = pen.state.pose;
    x.touching = x.X.p.x() < 0;
    x.X.p.x() = std::max(0.0, x.X.p.x());
    link.publish(x, static_cast<std::uint64_t>(i), pen.state.sequence, i * kMs);
    device.advance(kTick);
    run.off |= pen.reason == ForceOff::energy;
    run.damped |= (pen.flags & TEGOTAE_SHM_FLAG_DAMPED) != 0;
    if (i >= 9500) run.end.add(device.true_pose().p.x());
  }
  return run;
}

SafetySettings without_controller() {
  SafetySettings s;
  s.passivity_control = false;
  s.energy_bound = 1e9;
  s.continuous_force = 0;
  return s;
}

SafetySettings with_controller() {
  SafetySettings s;
  s.continuous_force = 0;
  return s;
}

}  // namespace

TEST_CASE("a sampled spring on the simulated pen grows or dies as its eigenvalues say, on the two sides of 2 b / T",
          "[servo]") {
  for (double part : {0.5, 0.9, 1.15, 1.5, 2.0}) {
    const double K = part * kBound;
    const SimulatedDeviceSettings s = loose_hand();
    // The hand rests at 0.2 mm and the spring is about 0.
    const Pose at = {Quat::Identity(), Vec3(2e-4, 0, 0)};
    SimulatedDevice device(s, StylusScript({{0, at}}));
    device.start();
    const double rest = s.hand.stiffness * 2e-4 / (s.hand.stiffness + K);
    const int ticks = 1000;
    double before = 0;
    double after = 0;
    for (int i = 0; i < ticks; ++i) {
      const double x = device.read().pose.p.x();
      device.write({Vec3(-K * x, 0, 0), Vec3::Zero()});
      device.advance(kTick);
      // The swing's amplitude over a tenth of a second at the begin and at the end.
      const double from_rest = std::abs(device.true_pose().p.x() - rest);
      if (i < 100) before = std::max(before, from_rest);
      if (i >= ticks - 100) after = std::max(after, from_rest);
    }
    const double expected = growth(s.mass + s.hand.mass, s.hand.stiffness, kDamping, K);
    CAPTURE(part, expected);
    CHECK((expected < 1) == (part < 1));
    CHECK(std::log(after / before) / (ticks - 100) == Approx(std::log(expected)).margin(1.5e-4));
  }
}

TEST_CASE("without the controller a wall is stable on one side of the bound and unstable on the other", "[servo]") {
  const WallRun soft = press_wall(0.5 * kBound, without_controller());
  CHECK(soft.end.size() < 1e-4);
  const WallRun stiff = press_wall(2 * kBound, without_controller());
  CHECK(stiff.end.size() > 5e-4);
  CHECK_FALSE(stiff.damped);
}

TEST_CASE("with the controller a wall is stable on both sides of the bound", "[servo]") {
  for (double part : {0.4, 1.5, 2.0, 3.0}) {
    const WallRun run = press_wall(part * kBound, with_controller());
    CAPTURE(part, run.end.size());
    CHECK(run.end.size() < 1e-4);
    CHECK_FALSE(run.off);
    CHECK(run.damped == (part > 1));
  }
}

TEST_CASE("an unstable wall without the controller turns the force off and says so", "[servo]") {
  SafetySettings s = with_controller();
  s.passivity_control = false;
  CHECK(press_wall(2 * kBound, s).off);
  CHECK_FALSE(press_wall(0.5 * kBound, s).off);
}
