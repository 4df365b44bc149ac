// What a device or an application may say that it should not: the wrench stays within its limits.
#include <cstring>
#include <limits>
#include <random>

#include "catch.hpp"
#include "puppet_device.hpp"
#include "tegotae/servo/servo.hpp"
#include "tegotae/transport/contact_link.hpp"

using namespace tegotae;
using test::engage;
using test::kMs;
using test::PuppetDevice;
using test::touching_at;

TEST_CASE("a device that is lost and a pen that is not finite get no force", "[servo]") {
  PuppetDevice device;
  Channel channel = Channel::create();
  ContactLink link(channel, {}, Vec3::Zero());
  Servo servo(device, channel);
  link.publish(touching_at(Vec3(0.001, 0, 0)), 1, 0, 0);
  PenSample pen;
  device.now = DeviceStatus::uninitialized;
  servo.tick(0);
  REQUIRE(link.read(pen));
  CHECK(pen.status == DeviceStatus::uninitialized);
  CHECK(pen.reason == ForceOff::disconnected);
  CHECK(device.rendered.force.norm() == 0);
  device.now = DeviceStatus::enabled;
  device.state.pose.p.y() = std::numeric_limits<double>::quiet_NaN();
  servo.tick(kMs);
  REQUIRE(link.read(pen));
  CHECK(pen.reason == ForceOff::not_finite);
  CHECK(device.rendered.force.norm() == 0);
}

TEST_CASE("whatever stands in the application's slot, the wrench stays within the limits", "[servo]") {
  PuppetDevice device;
  Channel channel = Channel::create();
  Servo servo(device, channel);
  std::mt19937_64 rng(11);
  for (int i = 0; i < 20'000; ++i) {
    std::uint64_t words[sizeof(tegotae_shm_application) / 8];
    for (std::uint64_t& word : words) {
      const double moderate = std::uniform_real_distribution<double>(-10, 10)(rng);
      std::memcpy(&word, &moderate, sizeof word);
      if (rng() % 8 == 0) word = rng();
    }
    tegotae_shm_application garbage;
    std::memcpy(&garbage, words, sizeof garbage);
    if (i % 2 == 0) garbage.heartbeat_ns = i * kMs;
    channel.write(garbage);
    servo.tick(i * kMs);
    REQUIRE(device.rendered.force.allFinite());
    REQUIRE(device.rendered.force.norm() <= 8.5 * (1 + 1e-15));
    REQUIRE(device.rendered.torque.norm() <= 0.188 * (1 + 1e-15));
    REQUIRE(device.center.allFinite());
  }
}

TEST_CASE("every field of the application's slot may hold garbage, one at a time or all", "[servo]") {
  PuppetDevice device;
  device.state.pose.p = Vec3(0, 0, -0.002);
  Channel channel = Channel::create();
  ContactLink link(channel, {}, Vec3(0.01, 0, 0));
  Servo servo(device, channel);
  std::mt19937_64 rng(12);
  ContactPlanes planes;
  planes.planes[0] = {Vec3::UnitZ(), Vec3::Zero(), 0};
  planes.count = 1;
  std::int64_t now = 0;
  std::uint64_t rendered = 0;
  Wrench last;
  constexpr std::size_t kWords = sizeof(tegotae_shm_application) / 8;
  for (int i = 0; i < 100'000; ++i) {
    now += kMs;
    // Long enough without garbage to be engaged and to press.
    const int phase = i % 400;
    planes.pen = device.state.pose;
    // Where garbage has left the pen, back into the wall.
    if (phase == 0) link.home(device.state.pose);
    // A plane holds the part wherever it is known; so it comes with the contact.
    if (phase < 300)
      link.publish({}, 0, 0, now);
    else
      link.publish(touching_at(Vec3::Zero()), 0, 0, now, planes);
    if (phase >= 340) {
      tegotae_shm_application slot;
      REQUIRE(channel.read(slot));
      std::uint64_t words[kWords];
      std::memcpy(words, &slot, sizeof slot);
      const std::uint64_t odd[] = {rng(), 0x7ff8000000000000u, 0x7ff0000000000000u, 0xffffffffffffffffu,
                                   0,     rng() >> 32};
      if (phase % 10 == 0)
        for (std::uint64_t& word : words) word = rng() % 2 == 0 ? word : odd[rng() % 6];
      else
        words[static_cast<std::size_t>(i) % kWords] = odd[rng() % 6];
      std::memcpy(&slot, words, sizeof slot);
      channel.write(slot);
    }
    servo.tick(now);
    REQUIRE(device.rendered.force.allFinite());
    REQUIRE(device.rendered.torque.allFinite());
    REQUIRE(device.rendered.force.norm() <= 8.5 * (1 + 1e-12));
    REQUIRE(device.rendered.torque.norm() <= 0.188 * (1 + 1e-12));
    const double step = (device.rendered.force - last.force).norm();
    REQUIRE((step <= 3 * (1 + 1e-9) || device.rendered.force.norm() == 0));
    last = device.rendered;
    REQUIRE(device.center.allFinite());
    rendered += device.rendered.force.norm() > 0.5 ? 1 : 0;
  }
  CHECK(rendered > 5'000);
}

TEST_CASE("a pen that jumps, says NaN or falls silent for 10 s gets no sudden force", "[servo]") {
  PuppetDevice device;
  Channel channel = Channel::create();
  ContactLink link(channel, {}, Vec3::Zero());
  Servo servo(device, channel);
  std::mt19937_64 rng(13);
  std::normal_distribution<double> normal;
  std::int64_t now = engage(servo, link);
  Wrench last;
  PenSample pen;
  const auto tick = [&](bool repeat) {
    now += kMs;
    // The wall x >= 0, the proxy on it.
    ProxyState x;
    if (link.read(pen) && pen.state.pose.p.allFinite()) x.X = pen.state.pose;
    x.touching = x.X.p.x() < 0;
    x.X.p.x() = std::max(0.0, x.X.p.x());
    link.publish(x, 0, 0, now);
    if (repeat) --device.state.sequence;
    device.state.time_ns = now;
    servo.tick(now);
    REQUIRE(link.read(pen));
    REQUIRE(device.rendered.force.norm() <= 8.5 * (1 + 1e-12));
    const double step = (device.rendered.force - last.force).norm();
    REQUIRE((step <= 3 * (1 + 1e-9) || device.rendered.force.norm() == 0));
    last = device.rendered;
  };
  const auto press = [&] {
    device.state.pose = {Quat::Identity(), Vec3(0.01, 0, 0)};
    for (int i = 0; i < 400; ++i) tick(false);
    for (int i = 0; i < 60; ++i) {
      device.state.pose.p.x() -= 0.2e-3;
      tick(false);
    }
    REQUIRE(device.rendered.force.x() > 1);
  };
  press();
  for (int i = 0; i < 10'000; ++i) {
    tick(true);
    if (i > 25) REQUIRE(device.rendered.force.norm() == 0);
  }
  CHECK(pen.reason == ForceOff::silent);
  device.state.pose.p.x() = -0.1;  // it comes back somewhere else
  for (int i = 0; i < 100; ++i) tick(false);
  CHECK(device.rendered.force.norm() == 0);
  CHECK(pen.reason == ForceOff::engage);
  for (int round = 0; round < 50; ++round) {
    press();
    const DeviceState good = device.state;
    switch (round % 4) {
      case 0:
        device.state.pose.p[static_cast<int>(rng() % 3)] = std::numeric_limits<double>::quiet_NaN();
        break;
      case 1:
        device.state.velocity.w.x() = std::numeric_limits<double>::infinity();
        break;
      case 2:
        device.state.pose.p += Vec3(normal(rng), normal(rng), normal(rng));
        break;
      default:
        device.state.pose.q.coeffs() *= 1 + normal(rng);
    }
    for (int i = 0; i < 10; ++i) tick(false);
    CHECK(device.rendered.force.norm() == 0);
    device.state.pose = good.pose;
    device.state.velocity = good.velocity;
    tick(false);
    CHECK(device.rendered.force.norm() == 0);
  }
}
