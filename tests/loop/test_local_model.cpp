// What the local model is for: the force of a servo whose contact loop is slow, against one ten times as fast.
#include <cmath>
#include <iostream>
#include <vector>

#include "bodies.hpp"
#include "catch.hpp"
#include "models/shapes.hpp"
#include "servo/puppet_device.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

using Path = Pose (*)(double t);

/// Down on the floor, 2 mm into it, along it in curves at up to 0.1 m/s while it turns and rocks, and up again.
Pose over_floor(double t) {
  const double down = 0.5 - 0.5 * std::cos(2 * M_PI * t / 2);
  return {rotation({0.02 * std::sin(5 * t), 0.02 * std::sin(7 * t), 0.3 * std::sin(2 * t)}),
          {0.02 * std::sin(4 * t), 0.02 * std::cos(3 * t), 0.0255 - 0.0075 * down}};
}

/// Down the hole's axis, then to and fro along it at up to 0.08 m/s while pressed against its wall all around.
Pose in_hole(double t) {
  const double in = std::min(1.0, t / 0.5);
  const double press = std::pow(std::sin(M_PI * std::max(0.0, t - 0.5) / 1.5), 2);
  return {rotation({0.01 * press * std::sin(6 * t), 0.01 * press * std::cos(5 * t), 0.5 * std::sin(t)}),
          {0.002 * press * std::sin(7 * t), 0.002 * press * std::cos(7 * t),
           0.026 - 0.012 * in + 0.006 * press * std::sin(4 * M_PI * t)}};
}

struct Forces {
  std::vector<Vec3> force;
  std::vector<Vec3> torque;
};

/// Forces at each tick of a servo at 1 kHz while the contact loop ticks every `every` of them.
Forces run(const Scene& scene, Path path, int every, bool local_model) {
  Scene unhurried = scene;
  unhurried.contact.tick_budget = INFINITY;  // the same on any load
  HapticLoop loop(unhurried);
  PuppetDevice device;
  Channel channel = Channel::create();
  ContactLink link(channel, loop.coupling(), loop.center());
  ServoSettings settings;
  settings.local_model = local_model;
  settings.safety.slew = {1e9, 1e9};
  Servo servo(device, channel, settings);
  Forces forces;
  Pose last = path(0);
  for (int i = 0; i < 2000; ++i) {
    const std::int64_t now = i * kMs;
    const Pose Y = path(1e-3 * i);
    const Displacement moved = displacement(last, Y, loop.center());
    device.state.pose = Y;
    device.state.velocity = {moved.dp / 1e-3, moved.dr / 1e-3};
    device.state.time_ns = now;
    last = Y;
    servo.tick(now);
    PenSample pen;
    REQUIRE(link.read(pen));
    if (i % every == 0) {
      const TickReport& report = loop.step(pen.state.pose, 1e-3 * every);
      link.publish(report.proxy, static_cast<std::uint64_t>(i), pen.state.sequence, now, report.planes);
    }
    forces.force.push_back(pen.wrench.force);
    forces.torque.push_back(pen.wrench.torque);
  }
  return forces;
}

double rms(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size()));
}

void compare(const char* name, const Scene& scene, Path path) {
  const Forces fast = run(scene, path, 1, false);
  const Forces slow = run(scene, path, 10, false);
  const Forces local = run(scene, path, 10, true);
  const std::vector<Vec3> zero(fast.force.size(), Vec3::Zero());
  const double size = rms(fast.force, zero);
  const double without = rms(slow.force, fast.force);
  const double with = rms(local.force, fast.force);
  std::cout << name << ": force " << size << " N rms; error at 100 Hz " << without << " N without, " << with
            << " N with the local model; torque " << 1e3 * rms(fast.torque, zero) << " mN m, "
            << 1e3 * rms(slow.torque, fast.torque) << ", " << 1e3 * rms(local.torque, fast.torque) << "\n";
  CHECK(size > 0.1);
  CHECK(with < 0.5 * without);
}

}  // namespace

TEST_CASE("between two ticks of a slow contact loop the local model keeps the force right", "[sim]") {
  SECTION("floor") {
    Scene scene;
    scene.parts.push_back({"floor", shared(box(Vec3(0.2, 0.2, 0.02))), {Quat::Identity(), {0, 0, 0}}, false});
    scene.parts.push_back({"box", shared(box(Vec3(0.03, 0.02, 0.02))), {Quat::Identity(), {0, 0.02, 0.0255}}, true});
    compare("box on a floor", scene, over_floor);
  }
  SECTION("hole") {
    Scene scene;
    shapes::Peg peg;
    peg.diameter = 0.0198;
    scene.parts.push_back({"hole", shared(shapes::block_with_hole({})), Pose{}, false});
    scene.parts.push_back({"peg", shared(shapes::peg(peg)), {Quat::Identity(), {0, 0, 0.026}}, true});
    compare("peg in its hole, 0.99", scene, in_hole);
  }
}
