// The weight of the held part in the hand: carried in the air, relieved by what the part lies on, and no source of
// energy.
#include <cmath>

#include "bodies.hpp"
#include "catch.hpp"
#include "servo/puppet_device.hpp"
#include "session/weight_ramp.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

/// 40 × 40 × 20 mm at 1000 kg/m³ are 32 g; `mass` instead, 30 mm over a floor.
Scene block_in_air(std::optional<double> mass, double mu = 0) {
  Scene scene;
  scene.contact.tick_budget = INFINITY;
  scene.friction.mu = mu;
  scene.weight.on = true;
  scene.parts.push_back({"floor", shared(box({0.4, 0.4, 0.02})), {Quat::Identity(), {0, 0, -0.01}}, false});
  scene.parts.push_back({"block", shared(box({0.04, 0.04, 0.02})), {Quat::Identity(), {0, 0, 0.04}}, true});
  scene.parts.back().mass = mass;
  return scene;
}

/// A pen on a servo at 1 kHz, with the contact loop behind it, as a run has them.
class Hand {
 public:
  explicit Hand(const Scene& scene)
      : loop_(scene), channel_(Channel::create()), link_(channel_, loop_.coupling(), loop_.center()) {
    ServoSettings settings;
    servo_ = std::make_unique<Servo>(device_, channel_, settings);
    last_ = scene.parts.back().pose;
  }
  /// One tick with the pen at `Y`; what is rendered.
  const PenSample& tick(const Pose& Y) {
    const std::int64_t now = ticks_ * kMs;
    const Displacement moved = displacement(last_, Y, loop_.center());
    device_.state.pose = Y;
    device_.state.velocity = {moved.dp / 1e-3, moved.dr / 1e-3};
    device_.state.time_ns = now;
    last_ = Y;
    servo_->tick(now);
    REQUIRE(link_.read(pen_));
    loop_.carry(ramp_.update(pen_, 1e-3));
    const TickReport& r = loop_.step(pen_.state.pose, 1e-3);
    link_.publish(r.proxy, static_cast<std::uint64_t>(ticks_++), pen_.state.sequence, now, r.planes);
    return pen_;
  }
  HapticLoop& loop() { return loop_; }

 private:
  HapticLoop loop_;
  PuppetDevice device_;
  Channel channel_;
  ContactLink link_;
  std::unique_ptr<Servo> servo_;
  WeightRamp ramp_;
  Pose last_;
  PenSample pen_;
  std::int64_t ticks_ = 0;
};

}  // namespace

TEST_CASE("the hand carries the part in the air, whatever it does, and the floor relieves it", "[sim][weight]") {
  const double mass = 0.1, weight = mass * 9.80665;
  const Scene scene = block_in_air(mass);
  Hand hand(scene);
  Pose Y = scene.parts[1].pose;
  double jump = 0, last = 0;
  for (int i = 0; i < 1000; ++i) {
    const double force = hand.tick(Y).wrench.force.norm();
    jump = std::max(jump, std::abs(force - last));
    last = force;
  }
  CHECK(jump < 0.02);  // it comes over 0.3 s
  CHECK(last == Approx(weight).epsilon(1e-6));
  CHECK((hand.loop().report().proxy.X.p - Y.p).norm() == Approx(weight / 800).epsilon(1e-6));
  CHECK(hand.loop().report().lag_reason == LagReason::none);
  // Moved about, by a meter a second at most, turned, and moved back: always the weight, and no energy.
  for (int i = 0; i < 2000; ++i) {
    const double a = 2 * M_PI * i / 500;
    Pose pen = Y;
    pen.p += Vec3(0.02 * std::sin(a), 0.01 * std::sin(2 * a), 0.02 * (1 - std::cos(a)));
    pen.q = rotation({0.2 * std::sin(a), 0, 0.3 * std::sin(a)}) * pen.q;
    const PenSample& sample = hand.tick(pen);
    REQUIRE(sample.reason == ForceOff::none);
    REQUIRE((sample.wrench.force - Vec3(0, 0, -weight)).norm() < 1e-6);
    REQUIRE(sample.wrench.torque.norm() < 1e-9);
    REQUIRE((sample.flags & TEGOTAE_SHM_FLAG_DAMPED) == 0);
  }
  // Down onto the floor: the force comes to zero where the part lies on its own, and then pushes up. Without a jump.
  double relieved = 1;
  for (int i = 0; i < 1600; ++i) {
    Y.p.z() -= 2e-5;
    const Vec3 force = hand.tick(Y).wrench.force;
    if (std::abs(Y.p.z() - 0.01001) < 1e-5) relieved = std::abs(force.z());
    REQUIRE(force.z() >= -weight - 1e-6);
  }
  CHECK(relieved < 0.15);  // the damper has 0.1 N at this speed
  CHECK(hand.tick(Y).wrench.force.z() > 0.5);
}

TEST_CASE("a part that lies on its own is held by friction under its own weight", "[sim][weight]") {
  const double mass = 0.1, mu = 0.4;
  const Scene scene = block_in_air(mass, mu);
  HapticLoop loop(scene);
  loop.carry(1);
  Pose Y = scene.parts[1].pose;
  for (int i = 0; i < 400; ++i) {
    Y.p.z() = std::max(0.01001, 0.04 - 1e-4 * i);
    loop.step(Y, 1e-3);
  }
  const Pose X = loop.report().proxy.X;
  const double breakaway = mu * mass * 9.80665 / 800;
  for (int i = 0; i < 90; ++i) {
    Y.p.x() += 0.01 * breakaway;
    loop.step(Y, 1e-3);
  }
  CHECK((loop.report().proxy.X.p - X.p).norm() < 1e-9);
  for (int i = 0; i < 100; ++i) {
    Y.p.x() += 0.01 * breakaway;
    loop.step(Y, 1e-3);
  }
  CHECK(loop.report().proxy.X.p.x() - X.p.x() == Approx(0.9 * breakaway).epsilon(0.02));
}

TEST_CASE("a weight that the device does not stand for is made smaller, and the loop says by how much",
          "[sim][weight]") {
  Scene scene = block_in_air(2);
  scene.weight.max_force = 0.7;
  const HapticLoop loop(scene);
  CHECK(loop.weight().mass == 2);
  CHECK(loop.weight().force.norm() == Approx(0.7));
  CHECK(loop.weight().share == Approx(0.7 / (2 * 9.80665)));
  const HapticLoop light(block_in_air({}));
  CHECK(light.weight().mass == Approx(0.032));  // volume by density
  CHECK(light.weight().share == 1);
  Scene off = block_in_air(1);
  off.weight.on = false;
  CHECK(HapticLoop(off).weight().force.isZero());
}

TEST_CASE("a weight that cannot be is refused", "[sim][weight]") {
  for (const double mass : {0.0, -1.0, 1e9, std::nan("")}) CHECK_THROWS_AS(HapticLoop(block_in_air(mass)), Error);
  Scene scene = block_in_air(1);
  scene.weight.gravity = {0, std::nan(""), 0};
  CHECK_THROWS_AS(HapticLoop(scene), Error);
  Scene lp = block_in_air(1);
  lp.contact.resolver = ResolverKind::lp;
  CHECK_THROWS_WITH(HapticLoop(lp), Catch::Contains("does not support weight"));
}
