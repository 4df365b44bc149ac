#include <unistd.h>

#include <optional>
#include <random>

#include "catch.hpp"
#include "puppet_device.hpp"
#include "servo/pen_mapping.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/transport/attachment.hpp"

using namespace tegotae;
using test::engage;
using test::kMs;
using test::PuppetDevice;

namespace {

DeviceState pen_at(const Vec3& p, const Vec3& turn = Vec3::Zero()) {
  DeviceState pen;
  pen.pose = {rotation(turn), p};
  return pen;
}

void check_pose(const Pose& a, const Pose& b) {
  CHECK((a.p - b.p).norm() < 1e-12);
  CHECK(a.q.angularDistance(b.q) < 1e-7);
}

}  // namespace

TEST_CASE("without commands the pen is the part", "[servo]") {
  PenMapping mapping({});
  MappingCommand command;
  const Vec3 center(0.02, 0.01, -0.03);
  command.center = center;
  for (int i = 0; i < 50; ++i) {
    const DeviceState pen = pen_at(Vec3(0.01 * i, 0.1, -0.02 * i), Vec3(0.05 * i, -0.02 * i, 0.3));
    CHECK_FALSE(mapping.update(pen, center, command));
    check_pose(mapping.Y(), pen.pose);
  }
}

TEST_CASE("a pen that acts at its tip turns the part about the part's center", "[servo]") {
  PenMapping mapping({});
  MappingCommand command;
  command.center = Vec3(0, 0, 0.1);
  mapping.update(pen_at(Vec3::Zero()), Vec3::Zero(), command);
  command.home_counter = 1;
  command.home = {rotation(Vec3(0.3, 0, 0)), Vec3(1, 2, 3)};
  CHECK(mapping.update(pen_at(Vec3(0.1, 0, 0), Vec3(0, 0.2, 0)), Vec3::Zero(), command));
  check_pose(mapping.Y(), command.home);
  CHECK_FALSE(mapping.update(pen_at(Vec3(0.1, 0, 0), Vec3(0, 0.5, 0)), Vec3::Zero(), command));
  CHECK((mapping.Y() * command.center - command.home * command.center).norm() < 1e-12);
  // In the world the part turns as the pen: by 0.3 rad about y.
  check_pose({mapping.Y().q, Vec3::Zero()}, {rotation(Vec3(0, 0.3, 0)) * command.home.q, Vec3::Zero()});
}

TEST_CASE("a scale multiplies ways from where it was set, and velocities", "[servo]") {
  PenMapping mapping({});
  MappingCommand command;
  mapping.update(pen_at(Vec3(0.1, 0, 0)), Vec3::Zero(), command);
  command.scale = 5;
  DeviceState pen = pen_at(Vec3(0.11, 0, 0));
  pen.velocity = {Vec3(0, 0.1, 0), Vec3(0, 0, 2)};
  CHECK(mapping.update(pen, Vec3::Zero(), command));
  CHECK((mapping.Y().p - Vec3(0.15, 0, 0)).norm() < 1e-12);
  CHECK((mapping.velocity().v - Vec3(0, 0.5, 0)).norm() < 1e-12);
  CHECK(mapping.velocity().w == Vec3(0, 0, 2));
  CHECK_FALSE(mapping.update(pen, Vec3::Zero(), command));
}

TEST_CASE("a clutch holds the part, or its place, while the pen moves on", "[servo]") {
  MappingSettings settings;
  settings.clutch_buttons = 2;
  settings.clutch_by_button = Clutch::translation;
  PenMapping mapping(settings);
  MappingCommand command;
  mapping.update(pen_at(Vec3::Zero()), Vec3::Zero(), command);
  DeviceState pen = pen_at(Vec3(0.1, 0, 0), Vec3(0, 0, 0.2));
  pen.buttons = 3;
  CHECK(mapping.update(pen, Vec3::Zero(), command));
  CHECK(mapping.clutch() == Clutch::translation);
  check_pose(mapping.Y(), {rotation(Vec3(0, 0, 0.2)), Vec3::Zero()});
  command.clutch = Clutch::all;
  pen.pose.q = rotation(Vec3(0, 0, 0.5));
  mapping.update(pen, Vec3::Zero(), command);
  check_pose(mapping.Y(), {rotation(Vec3(0, 0, 0.2)), Vec3::Zero()});
  CHECK(mapping.velocity().w.norm() == 0);
  // Released, it goes on from where it was.
  command.clutch = Clutch::none;
  pen.buttons = 0;
  CHECK(mapping.update(pen, Vec3::Zero(), command));
  check_pose(mapping.Y(), {rotation(Vec3(0, 0, 0.2)), Vec3::Zero()});
  pen.pose.p.x() += 0.01;
  mapping.update(pen, Vec3::Zero(), command);
  CHECK((mapping.Y().p - Vec3(0.01, 0, 0)).norm() < 1e-12);
}

TEST_CASE("a new application starts with no home, and its first one counts", "[servo]") {
  PenMapping mapping({});
  MappingCommand command;
  command.attachment = 1;
  command.home_counter = 1;
  command.home.p = Vec3(1, 0, 0);
  mapping.update(pen_at(Vec3::Zero()), Vec3::Zero(), command);
  CHECK(mapping.Y().p == Vec3(1, 0, 0));
  command.attachment = 2;
  command.home_counter = 0;
  mapping.update(pen_at(Vec3::Zero()), Vec3::Zero(), command);
  CHECK(mapping.Y().p == Vec3(1, 0, 0));
  command.home_counter = 1;
  command.home.p = Vec3(2, 0, 0);
  CHECK(mapping.update(pen_at(Vec3::Zero()), Vec3::Zero(), command));
  CHECK(mapping.Y().p == Vec3(2, 0, 0));
}

TEST_CASE("scale and clutch never move the part, whatever the pen does", "[servo]") {
  std::mt19937 rng(5);
  std::normal_distribution<double> normal;
  const auto random = [&](double size) { return Vec3(size * Vec3(normal(rng), normal(rng), normal(rng))); };
  PenMapping mapping({});
  MappingCommand command;
  command.center = random(0.1);
  Pose pen;
  mapping.update(pen_at(Vec3::Zero()), Vec3::Zero(), command);
  for (int i = 0; i < 5000; ++i) {
    const Pose before = mapping.Y();
    // While the pen stands still, commands change.
    if (i % 3 == 0) command.scale = std::exp(normal(rng));
    if (i % 5 == 0) command.clutch = static_cast<Clutch>(rng() % 3);
    DeviceState state;
    state.pose = pen;
    mapping.update(state, Vec3::Zero(), command);
    REQUIRE((mapping.Y().p - before.p).norm() < 1e-9);
    REQUIRE(mapping.Y().q.angularDistance(before.q) < 1e-7);
    pen = {(rotation(random(0.01)) * pen.q).normalized(), pen.p + random(0.001)};
    state.pose = pen;
    mapping.update(state, Vec3::Zero(), command);
    REQUIRE(mapping.Y().q.norm() == Approx(1).epsilon(1e-12));
  }
}

TEST_CASE("no change of the mapping lets the force jump", "[servo]") {
  // The pen presses a wall at x = 0 with 2.4 N and slides along it while everything is changed.
  PuppetDevice device;
  Channel channel = Channel::create();
  ContactLink link(channel, {}, Vec3::Zero());
  ServoSettings settings;
  settings.mapping.clutch_buttons = 1;
  settings.safety.dead_man_buttons = 2;
  Servo servo(device, channel, settings);
  device.state.buttons = 2;
  std::int64_t now = engage(servo, link);
  Vec3 last = Vec3::Zero();
  double largest_step = 0;
  double largest = 0;
  std::uint64_t reasons = 0;
  const auto run = [&](int ticks, const Vec3& way) {
    for (int i = 0; i < ticks; ++i) {
      PenSample pen;
      REQUIRE(link.read(pen));
      ProxyState x;
      x.X = pen.state.pose;
      x.touching = x.X.p.x() < 0;
      x.X.p.x() = std::max(0.0, x.X.p.x());
      now += kMs;
      link.publish(x, 0, 0, now);
      device.state.pose.p += way / ticks;
      device.state.time_ns = now;
      servo.tick(now);
      REQUIRE(link.read(pen));
      largest_step = std::max(largest_step, (device.rendered.force - last).norm());
      largest = std::max(largest, device.rendered.force.norm());
      last = device.rendered.force;
      reasons |= std::uint64_t{1} << static_cast<int>(pen.reason);
    }
  };
  run(100, Vec3(-0.003, 0, 0));
  CHECK(last.x() > 2);
  const auto change = [&](auto command) {
    command();
    run(300, Vec3(0, 0.01, 0));
  };
  change([&] { link.set_scale(10); });
  link.set_scale(1);
  run(10, Vec3::Zero());
  link.home({Quat::Identity(), Vec3(0.02, 0, 0)});
  run(300, Vec3::Zero());
  run(200, Vec3(-0.023, 0, 0));
  CHECK(last.x() > 2);
  change([&] { link.set_scale(0.1); });
  link.set_scale(1);
  link.home({Quat::Identity(), Vec3(0.02, 0, 0)});
  run(300, Vec3::Zero());
  run(200, Vec3(-0.023, 0, 0));
  CHECK(last.x() > 2);
  change([&] { device.state.buttons = 3; });  // clutched
  CHECK(last.norm() == 0);
  change([&] { device.state.buttons = 2; });
  link.home({Quat::Identity(), Vec3(0.01, 0, 0)});
  run(300, Vec3::Zero());
  run(100, Vec3(-0.013, 0, 0));
  CHECK(last.x() > 2);
  change([&] { device.state.buttons = 0; });  // dead man
  CHECK(last.norm() == 0);
  change([&] { device.state.buttons = 2; });
  CHECK(largest > 2);
  CHECK(largest_step <= 3 * (1 + 1e-9));
  for (ForceOff reason : {ForceOff::none, ForceOff::clutched, ForceOff::dead_man, ForceOff::engage})
    CHECK((reasons >> static_cast<int>(reason) & 1) == 1);
}

TEST_CASE("a scale out of range is refused", "[servo]") {
  Channel channel = Channel::create();
  ContactLink link(channel, {}, Vec3::Zero());
  CHECK_THROWS_WITH(link.set_scale(0), Catch::Contains("scale"));
  CHECK_THROWS_WITH(link.set_scale(1e9), Catch::Contains("scale"));
}

TEST_CASE("an attachment keeps its scale over devices", "[servo]") {
  const std::string name = "tegotae-scale-" + std::to_string(getpid());
  PuppetDevice device;
  std::optional<Attachment> pen;
  std::int64_t now = 0;
  for (int life = 0; life < 2; ++life) {
    Channel channel = Channel::create(name);
    Servo servo(device, channel, {});
    device.state.pose = {};
    if (!pen) pen.emplace("shm:" + name, CouplingSettings{}, Vec3::Zero(), 5);
    ProxyState x;
    x.X.p = Vec3(0.1, 0, 0);
    PenSample sample;
    const auto turn = [&] {
      now += 200 * kMs;  // long enough for the next look for a device
      servo.tick(now);
      const bool there = pen->read(sample, now);
      pen->publish(x, 0, 0, now);
      return there;
    };
    bool there = false;
    for (int i = 0; i < 5 && !there; ++i) there = turn();
    REQUIRE(there);
    device.state.pose.p = Vec3(0.001, 0, 0);
    turn();
    CHECK(turn());
    CHECK(sample.state.pose.p.x() == Approx(0.1 + 5 * 0.001).epsilon(1e-12));
  }
}
