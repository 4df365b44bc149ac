#include <cstdlib>
#include <vector>

#include "alloc_guard.hpp"
#include "catch.hpp"
#include "puppet_device.hpp"
#include "tegotae/device/simulated_device.hpp"
#include "tegotae/servo/servo.hpp"
#include "tegotae/transport/contact_link.hpp"

using namespace tegotae;
using test::engage;
using test::kMs;
using test::PuppetDevice;
using test::touching_at;

namespace {

/// Moves the pen by a script against the wall x >= 0, the proxy being the pen's center projected on the wall, in
/// virtual time; gives back what the contact loop saw.
std::vector<PenSample> push_wall(int ticks) {
  const StylusScript script(
      {{0, {Quat::Identity(), Vec3(0.02, 0, 0)}}, {0.3, {rotation(Vec3(0, 0.1, 0)), Vec3(-0.01, 0.005, 0)}}});
  SimulatedDevice device({}, script);
  device.start();
  Channel channel = Channel::create();
  ContactLink link(channel, {}, Vec3::Zero());
  Servo servo(device, channel);
  std::vector<PenSample> seen;
  for (int i = 0; i < ticks; ++i) {
    const std::int64_t now = i * kMs;
    device.advance(1e-3);
    servo.tick(now);
    PenSample pen;
    REQUIRE(link.read(pen));
    seen.push_back(pen);
    ProxyState x;
    x.X = pen.state.pose;
    x.touching = x.X.p.x() < 0;
    x.X.p.x() = std::max(0.0, x.X.p.x());
    if (x.touching) x.X.q = Quat::Identity();
    link.publish(x, static_cast<std::uint64_t>(i), pen.state.sequence, now);
  }
  return seen;
}

}  // namespace

TEST_CASE("a tick renders the coupling to the newest proxy and tells of the pen", "[servo]") {
  PuppetDevice device;
  Channel channel = Channel::create();
  const Vec3 center(0.01, 0, 0);
  ContactLink link(channel, {800, 5, 0.3, 0.004}, center);
  Servo servo(device, channel);
  device.state = {{Quat::Identity(), Vec3(0, 0, -0.003)}, {Vec3(0, 0, -0.1), Vec3(0, 1, 0)}, 5, 77, 0};

  PenSample pen;
  CHECK_FALSE(link.read(pen));
  servo.tick(kMs);
  REQUIRE(link.read(pen));
  CHECK(pen.status == DeviceStatus::ready);
  CHECK(pen.reason == ForceOff::software);
  CHECK(pen.wrench.force.norm() == 0);

  const std::int64_t now = engage(servo, link, kMs);
  link.publish(touching_at(Vec3::Zero()), 1, 42, now);
  device.state.sequence = 41;
  servo.tick(now + kMs);
  REQUIRE(link.read(pen));
  CHECK((device.rendered.force - Vec3(0, 0, 800 * 0.003 + 5 * 0.1)).norm() < 1e-12);
  CHECK((device.rendered.torque - Vec3(0, -0.004, 0)).norm() < 1e-15);
  CHECK(device.center == center);
  CHECK(pen.wrench.force == device.rendered.force);
  CHECK(pen.wrench.torque == device.rendered.torque);
  CHECK(pen.status == DeviceStatus::enabled);
  CHECK(pen.reason == ForceOff::none);
  CHECK((pen.state.pose.p - Vec3(0, 0, -0.003)).norm() < 1e-15);
  CHECK(pen.raw.p == Vec3(0, 0, -0.003));
  CHECK(pen.state.velocity.w == Vec3(0, 1, 0));
  CHECK(pen.state.buttons == 5);
  CHECK(pen.state.time_ns == 77);
  CHECK(pen.state.sequence == 42);
  CHECK(pen.heartbeat_ns == now + kMs);
  CHECK(pen.tick == 251);

  ProxyState free = touching_at(Vec3::Zero());
  free.touching = false;
  link.publish(free, 2, 42, now + kMs);
  servo.tick(now + 2 * kMs);
  REQUIRE(link.read(pen));
  CHECK(device.rendered.force.norm() == 0);
  CHECK(pen.reason == ForceOff::none);
}

TEST_CASE("the force ends with the contact loop's heartbeat and comes back from a small force", "[servo]") {
  PuppetDevice device;
  Channel channel = Channel::create();
  ContactLink link(channel, {}, Vec3::Zero());
  Servo servo(device, channel);
  const std::int64_t died = engage(servo, link);
  link.publish(touching_at(Vec3(0.001, 0, 0)), 1, 0, died);
  for (int i = 1; i <= 20; ++i) {
    servo.tick(died + i * kMs);
    REQUIRE(device.rendered.force.x() == Approx(0.8));
  }
  PenSample pen;
  for (int i = 21; i <= 23; ++i) {
    servo.tick(died + i * kMs);
    REQUIRE(link.read(pen));
    CHECK(pen.reason == ForceOff::watchdog);
    CHECK(pen.status == DeviceStatus::ready);
  }
  CHECK(device.rendered.force.norm() == 0);
  std::int64_t now = died + 24 * kMs;
  // Pressed all the time it does not come back.
  for (int i = 0; i < 100; ++i, now += kMs) {
    link.publish(touching_at(Vec3(0.001, 0, 0)), 2, 0, now);
    servo.tick(now);
    REQUIRE(device.rendered.force.norm() == 0);
  }
  REQUIRE(link.read(pen));
  CHECK(pen.reason == ForceOff::engage);
  now = engage(servo, link, now);
  link.publish(touching_at(Vec3(0.001, 0, 0)), 3, 0, now);
  servo.tick(now + kMs);
  CHECK(device.rendered.force.x() == Approx(0.8));
  CHECK(servo.statistics().force_off[TEGOTAE_SHM_REASON_WATCHDOG] == 1);
}

TEST_CASE("closed over the simulated pen, pushing a wall settles where the springs balance", "[servo]") {
  const std::vector<PenSample> seen = push_wall(3000);
  // The hand (400 N/m) wants to be 10 mm inside, the coupling is 800 N/m: 3.33 mm and 2.67 N; the friction's dead zone
  // and the encoder's step apart.
  const PenSample& last = seen.back();
  CHECK(last.state.pose.p.x() == Approx(-0.01 / 3).margin(0.04 / 1200 + 3e-5));
  CHECK(last.wrench.force.x() == Approx(8.0 / 3).margin(800 * (0.04 / 1200 + 3e-5)));
  CHECK(last.wrench.force.tail<2>().norm() < 1e-12);
  // 1.5 N·m/rad of the hand against 0.3 of the coupling.
  CHECK(last.wrench.torque.y() == Approx(-0.3 * 0.1 * 1.5 / 1.8).margin(0.3 * 1e-4));
  // A rest: the last half second does not move by more than a step of the encoder.
  for (std::size_t i = 2500; i < seen.size(); ++i)
    REQUIRE((seen[i].state.pose.p - last.state.pose.p).cwiseAbs().maxCoeff() < 3.1e-5);
}

TEST_CASE("virtual time gives the same bits each time", "[servo]") {
  const std::vector<PenSample> a = push_wall(800);
  const std::vector<PenSample> b = push_wall(800);
  for (std::size_t i = 0; i < a.size(); ++i) {
    REQUIRE(a[i].state.pose.p == b[i].state.pose.p);
    REQUIRE(a[i].state.pose.q.coeffs() == b[i].state.pose.q.coeffs());
    REQUIRE(a[i].wrench.force == b[i].wrench.force);
    REQUIRE(a[i].wrench.torque == b[i].wrench.torque);
  }
}

TEST_CASE("the allocation guard counts", "[servo]") {
  const test::AllocGuard guard;
  CHECK(guard.count() == 0);
  const std::uint64_t before = guard.count();
  void* volatile memory = std::malloc(100);
  std::free(memory);
  const std::uint64_t after_malloc = guard.count();
  int* volatile object = new int(3);
  delete object;
  const std::uint64_t after_new = guard.count();
  CHECK(after_malloc == before + 2);
  CHECK(after_new == after_malloc + 2);
}

TEST_CASE("a servo tick allocates nothing", "[servo]") {
  SimulatedDevice device({}, StylusScript({{0, Pose()}, {1, {rotation(Vec3(0, 1, 0)), Vec3(0.1, 0, 0)}}}));
  device.start();
  Channel channel = Channel::create();
  ContactLink link(channel, {}, Vec3(0.01, 0, 0));
  ContactPlanes planes;
  Servo servo(device, channel);
  std::uint64_t allocations = 0;
  int local = 0;
  {
    const test::AllocGuard guard;
    PenSample pen;
    for (int i = 0; i < 1000; ++i) {
      device.advance(1e-3);
      servo.tick(i * kMs);
      link.read(pen);
      // In contact, out of contact, and silent for longer than the watchdog allows.
      ProxyState x = touching_at(Vec3(0.001, 0, 0));
      x.touching = i % 200 < 150;
      planes.count = i % 7;
      planes.X = x.X;
      planes.pen = pen.state.pose;
      for (int k = 0; k < planes.count; ++k)
        planes.planes[static_cast<std::size_t>(k)] = {Vec3::UnitX(), Vec3(0, 0.01 * k, 0.01 * (k % 3)), 0};
      local += (pen.flags & TEGOTAE_SHM_FLAG_LOCAL) != 0 ? 1 : 0;
      if (i < 900) link.publish(x, static_cast<std::uint64_t>(i), pen.state.sequence, i * kMs, planes);
    }
    allocations = guard.count();
  }
  CHECK(allocations == 0);
  CHECK(local > 100);  // until the pen has turned farther than flat planes can tell
}
