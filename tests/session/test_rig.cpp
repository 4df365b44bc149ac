// Rig: what it wires is what one wires by hand, and nothing of it is left out.
#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

#include "alloc_guard.hpp"
#include "bodies.hpp"
#include "catch.hpp"
#include "servo/puppet_device.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/device/simulated_device.hpp"
#include "tegotae/session/rig.hpp"

using namespace tegotae;
using namespace tegotae::test;
using Catch::Contains;

namespace {

/// A block that starts 5 mm over a floor, and another block beside it.
Scene floor_scene() {
  Scene scene;
  scene.add_fixed("floor", box(Vec3(0.2, 0.2, 0.02)), {Quat::Identity(), Vec3(0, 0, -0.01)});
  scene.add_held("block", box(Vec3(0.02, 0.02, 0.02)), {Quat::Identity(), Vec3(0, 0, 0.015)});
  scene.add_fixed("other", box(Vec3(0.02, 0.02, 0.02)), {Quat::Identity(), Vec3(0.05, 0, 0.02)});
  return scene;
}

/// Into the floor, along it with a turn, and out.
StylusScript press() {
  const auto at = [](double x, double z) { return Pose{rotation(Vec3(0, 0, 20 * x)), Vec3(x, 0, z)}; };
  return StylusScript({{0, at(0, 0.015)}, {0.3, at(0, 0.008)}, {0.8, at(0.01, 0.008)}, {1, at(0.01, 0.015)}});
}

RigSettings simulated(double period = 1e-3) {
  RigSettings settings;
  settings.clock = RigClock::simulated;
  settings.period = period;
  return settings;
}

/// A pen that goes down into the floor and then along it, a millimeter in 100 ms, and remembers the largest force
/// along.
class SlidingPen final : public PuppetDevice {
 public:
  double most_along = 0;
  void advance(double dt) noexcept override {
    time_ += dt;
    state.pose.p.z() = std::max(0.009, 0.015 - 0.02 * std::max(0.0, time_ - 0.3));
    state.pose.p.x() = 0.01 * std::max(0.0, time_ - 0.7);
    if (time_ > 0.8) most_along = std::max(most_along, std::abs(rendered.force.x()));
  }

 private:
  double time_ = 0;
};

}  // namespace

TEST_CASE("a rig does what its parts do, wired by hand", "[rig]") {
  SimulatedDevice pen({}, press());
  Rig rig(floor_scene(), pen, simulated());

  Scene scene = floor_scene();
  scene.contact.tick_budget = std::numeric_limits<double>::infinity();
  HapticLoop loop(scene);
  SimulatedDevice own_pen({}, press(), loop.center());
  Channel channel = Channel::create();
  own_pen.start();
  Servo servo(own_pen, channel);
  ContactLink link(channel, loop.coupling(), loop.center());

  rig.start();
  PenSample sample;
  double most = 0;
  for (std::uint64_t ms = 0; ms < 1100; ++ms) {
    const TickReport& mine = rig.step();
    const auto now_ns = static_cast<std::int64_t>(ms) * kMs;
    servo.tick(now_ns);
    REQUIRE(link.read(sample));
    const TickReport& own = loop.step(sample.state.pose, 1e-3);
    link.publish(own.proxy, ms, sample.state.sequence, now_ns, own.planes);
    own_pen.advance(1e-3);
    REQUIRE(mine.proxy.X.p == own.proxy.X.p);
    REQUIRE(mine.proxy.X.q.coeffs() == own.proxy.X.q.coeffs());
    REQUIRE(rig.pen().wrench.force == sample.wrench.force);
    REQUIRE(rig.contacts().size() == loop.contacts().size());
    REQUIRE(rig.connected());
    most = std::max(most, sample.wrench.force.z());
  }
  CHECK(most > 0.5);
  CHECK(rig.steps() == 1100);
  CHECK(rig.time() == Approx(1.099));
}

TEST_CASE("a rig gives the servo the contact planes, so that slow steps are not felt along a wall", "[rig]") {
  double along[2];
  for (const bool local_model : {true, false}) {
    SlidingPen pen;
    pen.state.pose.p.z() = 0.015;
    RigSettings settings = simulated(0.01);  // ten servo ticks a step
    settings.servo.local_model = local_model;
    Rig rig(floor_scene(), pen, settings);
    rig.start();
    rig.run(1.5, [](const Rig&) {});
    REQUIRE(pen.rendered.force.z() > 0.5);
    along[local_model ? 0 : 1] = pen.most_along;
  }
  // Without them the part stands for 10 ms while the pen goes on by 0.1 mm: 80 mN, and less on average.
  CHECK(along[1] > 0.04);
  CHECK(along[0] < 0.5 * along[1]);
}

TEST_CASE("a rig continues in a changed scene, with the same part or another one", "[rig]") {
  PuppetDevice pen;
  pen.state.pose.p.z() = 0.015;
  Rig rig(floor_scene(), pen, simulated());
  rig.start();
  for (int i = 0; i < 300; ++i) rig.step();
  Scene scene = floor_scene();
  scene.parts.pop_back();
  pen.state.pose.p.x() = 0.05;  // where the other block was
  const SceneChange less = rig.change(scene);
  CHECK(less.state() == ChangeState::pending);
  for (int i = 0; i < 100; ++i) rig.step();
  CHECK(less.state() == ChangeState::in_force);
  CHECK(rig.part().p.x() == Approx(0.05).margin(1e-6));

  // The other block, held 20 mm over the floor; the pen is where it is and comes to mean it.
  scene = floor_scene();
  scene.parts[1].held = false;
  scene.parts[2].held = true;
  scene.parts[2].pose.p = Vec3(0.08, 0, 0.03);
  const SceneChange another = rig.change(scene);
  for (int i = 0; i < 10; ++i) {
    rig.step();
    CHECK(rig.pen().wrench.force.norm() == 0);
  }
  REQUIRE(another.state() == ChangeState::in_force);
  CHECK((rig.part().p - Vec3(0.08, 0, 0.03)).norm() < 1e-9);
  pen.state.pose.p.z() -= 0.005;
  for (int i = 0; i < 100; ++i) rig.step();
  CHECK((rig.part().p - Vec3(0.08, 0, 0.025)).norm() < 1e-6);
}

TEST_CASE("a rig in real time runs until it is asked to stop, and its scene is changed from another thread", "[rig]") {
  SimulatedDevice pen({}, press());
  Rig rig(floor_scene(), pen);
  rig.start();
  std::atomic<bool> changed{false};
  std::thread editor([&] {
    Scene scene = floor_scene();
    scene.parts.pop_back();
    changed = rig.change(scene).wait(60) == ChangeState::in_force;
    rig.request_stop();
  });
  std::uint64_t steps = 0;
  rig.run(120, [&steps](const Rig&) { ++steps; });
  editor.join();
  CHECK(changed);
  CHECK(steps == rig.steps());
  CHECK(rig.time() < 120);
  rig.stop();
  const Pose at = rig.part();
  rig.step();  // without effect
  CHECK(rig.part().p == at.p);
  CHECK(pen.status() == DeviceStatus::uninitialized);
}

TEST_CASE("a step of a rig does not allocate", "[rig][allocation]") {
  SimulatedDevice pen({}, press());
  Rig rig(floor_scene(), pen, simulated());
  rig.start();
  for (int i = 0; i < 400; ++i) rig.step();
  std::uint64_t allocations = 0;
  for (int i = 0; i < 400; ++i) {
    const AllocGuard guard;
    rig.step();
    allocations += guard.count();
  }
  CHECK(!rig.contacts().empty());
  CHECK(allocations == 0);
}

TEST_CASE("what a rig cannot do it refuses", "[rig]") {
  SimulatedDevice pen({}, press());
  CHECK_THROWS_WITH(Rig(floor_scene(), pen, simulated(0)), Contains("period"));
  CHECK_THROWS_WITH(Rig(floor_scene(), pen, simulated(std::nan(""))), Contains("period"));
  CHECK_THROWS_AS(Rig(floor_scene(), "shm:/tegotae-nobody-has-this-name"), Error);
  Scene none = floor_scene();
  none.parts[1].held = false;
  CHECK_THROWS_WITH(Rig(none, pen), Contains("no part is held"));
}

TEST_CASE("a rig guides the hand along a path, another one, and no more", "[rig][guide]") {
  Scene scene = floor_scene();
  const auto at = [](double x, double y) { return Pose{Quat::Identity(), Vec3(x, y, 0.015)}; };
  SimulatedDevice pen({}, StylusScript({{0, at(0, 0)}}));
  Rig rig(scene, pen, simulated());
  rig.start();
  double jump = 0, off = 0;
  Vec3 last = Vec3::Zero();
  const auto steps = [&](int count) {
    for (int i = 0; i < count; ++i) {
      rig.step();
      const Vec3 force = rig.pen().wrench.force;
      jump = std::max(jump, (force - last).norm());
      last = force;
      off += rig.pen().reason != ForceOff::none && rig.time() > 0.1 ? 1 : 0;
    }
    return last;
  };
  CHECK(steps(1000).norm() < 1e-6);
  rig.guide({at(0, 0), at(0.1, 0)});
  CHECK(steps(1000).x() == Approx(1).epsilon(0.01));
  CHECK(std::abs(last.y()) < 0.01);
  // The other one begins where the pull has taken the pen.
  const Pose there = rig.pen().state.pose;
  rig.guide({there, at(there.p.x(), 0.1)});
  CHECK(steps(1000).y() > 0.9);
  CHECK(last.norm() < 1.001);
  rig.guide({});
  CHECK(steps(1000).norm() < 0.01);
  CHECK(jump < 0.02);
  CHECK(off == 0);
  // In the other part's hand nothing pulls.
  rig.guide({at(0, 0), at(0.1, 0)});
  steps(1000);
  scene.parts[1].held = false;
  scene.parts[1].pose = rig.part();
  scene.parts[2].held = true;
  scene.parts[2].pose.p.x() = 0.1;
  rig.change(scene);
  CHECK(steps(1000).norm() < 0.01);
  CHECK(rig.loop().held() == "other");
}

TEST_CASE("a guide follows the rules of the scene in force", "[rig][guide]") {
  Scene scene = floor_scene();
  const Pose start{Quat::Identity(), Vec3(0, 0, 0.015)}, end{Quat::Identity(), Vec3(0.1, 0, 0.015)};
  SimulatedDevice pen({}, StylusScript({{0, start}}));
  Rig rig(scene, pen, simulated());
  rig.start();
  rig.step();
  scene.contact.resolver = ResolverKind::lp;
  rig.change(scene);
  rig.guide({start, end});  // pending: the scene in force has qp
  rig.guide({});
  rig.step();
  CHECK_THROWS_WITH(rig.guide({start, end}), Contains("lp does not support a load"));
  scene.contact.resolver = ResolverKind::qp;
  scene.weight.max_force = 0.25;
  rig.change(scene);
  scene.contact.resolver = ResolverKind::impulse;
  rig.change(scene);  // replaces the one that is pending
  scene.contact.resolver = ResolverKind::qp;
  rig.change(scene);
  rig.step();
  rig.guide({start, end});
  for (int i = 0; i < 1000; ++i) rig.step();
  // Half of the force that the device stands for, of which the weight may take the other half.
  CHECK(rig.pen().wrench.force.norm() == Approx(0.25).epsilon(0.01));
}

TEST_CASE("a guided step allocates nothing; what knows no load is not guided", "[rig][guide]") {
  const Pose start{Quat::Identity(), Vec3(0, 0, 0.015)};
  Scene scene = floor_scene();
  {
    SimulatedDevice pen({}, press());
    Rig rig(scene, pen, simulated());
    rig.start();
    rig.guide({start, {Quat::Identity(), Vec3(0.05, 0, 0.015)}});
    for (int i = 0; i < 300; ++i) rig.step();
    const AllocGuard guard;
    for (int i = 0; i < 700; ++i) rig.step();
    CHECK(guard.count() == 0);
  }
  scene.contact.resolver = ResolverKind::lp;
  SimulatedDevice pen({}, press());
  Rig rig(scene, pen, simulated());
  CHECK_THROWS_WITH(rig.guide({start}), Contains("the resolver lp does not support a load; qp does"));
}
