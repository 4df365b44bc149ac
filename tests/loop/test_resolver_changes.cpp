// From every resolver to every other under load: what reaches the servo is of the resolver in force, and nothing of the
// one before.
#include <cmath>
#include <string>

#include "bodies.hpp"
#include "catch.hpp"
#include "servo/puppet_device.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr double kPressed = 0.002;  // m that the pen is in the floor

/// A block on a floor, both 20 mm thick; `touching`: they touch at the start, so that the pair is relieved.
Scene floor_scene(const std::string& resolver, bool touching = false) {
  Scene scene;
  scene.contact.resolver = resolver_kind(resolver);
  scene.contact.tick_budget = INFINITY;
  scene.parts = {
      {"floor", shared(box(Vec3(0.2, 0.2, 0.02))), {Quat::Identity(), Vec3(0, 0, -0.01)}},
      {"block", shared(box(Vec3(0.02, 0.02, 0.02))), {Quat::Identity(), Vec3(0, 0, touching ? 0.01 : 0.015)}, true}};
  return scene;
}

/// A contact loop whose pen stands pressed into the floor, with its servo.
struct Pressed {
  explicit Pressed(const Scene& scene)
      : loop(scene), channel(Channel::create()), servo(pen, channel), link(channel, loop.coupling(), loop.center()) {
    pen.state.pose.p = Vec3(0, 0, 0.015);
  }

  void step() {
    now += kMs;
    servo.tick(now);
    PenSample sample;
    REQUIRE(link.read(sample));
    const TickReport& r = loop.step(sample.state.pose, 1e-3);
    link.publish(r.proxy, tick++, sample.state.sequence, now, r.planes);
  }
  /// Engages the force in the air, then goes down into the floor.
  void press() {
    for (int i = 0; i < 300; ++i) step();
    for (int i = 0; i < 500; ++i) {
      pen.state.pose.p.z() = 0.015 - (0.005 + kPressed) * (i + 1) / 500;
      step();
    }
    for (int i = 0; i < 300; ++i) step();
  }

  PuppetDevice pen;
  HapticLoop loop;
  Channel channel;
  Servo servo;
  ContactLink link;
  std::int64_t now = 0;
  std::uint64_t tick = 0;
};

/// What the pen should feel at rest, N, by closed forms.
double expected(const std::string& resolver) {
  const CouplingSettings k;
  // Four corners that push back with 2000 N/m each, in series with the coupling.
  const double walls = 4 * PenaltySettings().stiffness;
  return resolver == "penalty" ? kPressed / (1 / k.stiffness + 1 / walls) : kPressed * k.stiffness;
}

}  // namespace

TEST_CASE("after a change of the resolver the wrench is that of the new one", "[resolver_changes]") {
  const std::string from = GENERATE("qp", "lp", "impulse", "penalty");
  const std::string to = GENERATE("qp", "lp", "impulse", "penalty");
  CAPTURE(from, to);
  Pressed run(floor_scene(from));
  run.press();
  // The gap that is kept, up to 7 µm, is felt as 6 mN.
  REQUIRE(run.pen.rendered.force.z() == Approx(expected(from)).epsilon(0.02));
  if (from == "qp") REQUIRE(run.loop.report().planes.count > 0);
  if (from == "penalty") REQUIRE(run.loop.report().depth > 0);

  Scene next = floor_scene(to);
  next.parts[1].pose = run.loop.latest();
  // What the springs let in is refused as a start.
  if (from == "penalty") next.parts[1].pose.p.z() = 0.0101;
  run.loop.change(next);
  bool changed = false;
  for (int i = 0; i < 1500; ++i) {
    run.step();
    changed |= run.loop.change_in_force() == 1;
    if (!changed) {  // the part is in the floor: the pen comes up until the change can come into force
      run.pen.state.pose.p.z() = 0.0105;
      continue;
    }
    run.pen.state.pose.p.z() = std::max(run.pen.state.pose.p.z() - 1e-5, 0.01 - kPressed);
    const TickReport& r = run.loop.report();
    REQUIRE((r.planes.count == 0 || to == "qp"));
    REQUIRE((r.forces.count == 0 || to == "qp"));
    REQUIRE((r.depth == 0 || to == "penalty"));
  }
  REQUIRE(changed);
  const TickReport& r = run.loop.report();
  CHECK(run.pen.rendered.force.z() == Approx(expected(to)).epsilon(0.02));
  CHECK((r.planes.count > 0) == (to == "qp"));
  CHECK((r.forces.count > 0) == (to == "qp"));
  CHECK((r.depth > 0) == (to == "penalty"));
}

TEST_CASE("what was said of the pairs of one scene's start is not said of the next one's", "[resolver_changes]") {
  const std::string resolver = GENERATE("qp", "lp", "impulse", "penalty");
  CAPTURE(resolver);
  HapticLoop loop(floor_scene("qp", true));
  loop.step({Quat::Identity(), Vec3(0, 0, 0.01)}, 1e-3);
  const int waiting = loop.report().shrunk;
  Scene next = floor_scene(resolver);
  next.parts[0].pose.p.z() -= 0.03;
  next.parts[1].pose = loop.latest();
  loop.change(next);
  for (int i = 0; i < 50 && loop.change_in_force() == 0; ++i) loop.step(loop.latest(), 1e-3);
  REQUIRE(loop.change_in_force() == 1);
  CHECK(loop.report().shrunk == 0);
  CHECK(loop.report().filtered == 0);
  CHECK(loop.report().contacts == 0);
  CHECK(waiting >= 0);
}
