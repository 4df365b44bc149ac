// What is felt where nothing touches, while scenes and resolvers change: nothing.
#include <cmath>
#include <iostream>
#include <limits>
#include <random>

#include "bodies.hpp"
#include "catch.hpp"
#include "fcl_oracle.hpp"
#include "servo/puppet_device.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/servo/servo.hpp"
#include "tegotae/transport/contact_link.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

const char* const kResolvers[] = {"qp", "lp", "impulse", "penalty"};
const auto kBoard = shared(box(Vec3(0.2, 0.2, 0.01)));
constexpr double kAir = 1e-3;  // m: nothing is nearer than this where nothing may be felt

Scene block_over_floor(const std::string& resolver, const Pose& X) {
  Scene scene;
  scene.contact.tick_budget = INFINITY;
  scene.contact.resolver = resolver_kind(resolver);
  scene.parts = {{"floor", kBoard, {Quat::Identity(), Vec3(0, 0, -0.005)}},
                 {"block", shared(box(Vec3(0.02, 0.02, 0.02))), X, true}};
  return scene;
}

/// `scene` with its held box larger by kAir on each side: where that meets nothing, nothing is near.
Scene inflated(Scene scene, const Vec3& size) {
  for (Part& p : scene.parts)
    if (p.held) p.mesh = shared(box(size + Vec3::Constant(2 * kAir)));
  return scene;
}

/// A pen, a servo whose chain lets the wrench change at once, and a contact loop, in virtual time.
struct Hand {
  explicit Hand(const Scene& scene)
      : loop(scene), link(channel, loop.coupling(), loop.center()), servo(device, channel, settings()) {
    device.state.pose = loop.latest();
  }
  static ServoSettings settings() {
    ServoSettings s;
    s.safety.slew = {1e9, 1e9};
    return s;
  }

  /// One millisecond with the pen at `Y`; the wrench is what the servo rendered for the tick before this one.
  Wrench go(const Pose& Y) {
    const Displacement moved = displacement(device.state.pose, Y, loop.center());
    device.state.pose = Y;
    device.state.velocity = {moved.dp / 1e-3, moved.dr / 1e-3};
    device.state.time_ns = now;
    servo.tick(now);
    PenSample pen;
    REQUIRE(link.read(pen));
    const TickReport& report = loop.step(pen.state.pose, 1e-3);
    link.publish(report.proxy, ++tick, pen.state.sequence, now, report.planes);
    now += kMs;
    return pen.wrench;
  }

  HapticLoop loop;
  PuppetDevice device;
  Channel channel = Channel::create();
  ContactLink link;
  Servo servo;
  std::int64_t now = 0;
  std::uint64_t tick = 0;
};

/// Straight to `to` in `ticks`; the greatest force.
double lead(Hand& hand, const Vec3& to, int ticks) {
  const Vec3 from = hand.device.state.pose.p;
  double most = 0;
  for (int i = 1; i <= ticks; ++i)
    most = std::max(most, hand.go({Quat::Identity(), from + (to - from) * i / ticks}).force.norm());
  return most;
}

/// A pen that wanders about, `reach` m and 1 rad to each side.
Pose wander(std::mt19937& rng, const Pose& Y, const Pose& goal) {
  const Displacement d = displacement(Y, goal, Vec3::Zero());
  std::uniform_real_distribution<double> pace(0, 3e-4);
  const double way = d.dp.norm() + 0.02 * d.dr.norm();
  return way > 0 ? displaced(Y, Vec3::Zero(), std::min(1.0, pace(rng) / way) * d) : goal;
}

struct Counts {
  std::int64_t ticks = 0, changes = 0, refused = 0, in_air = 0, felt = 0, felt_in_air = 0, intersecting = 0;
  double most_in_air = 0;  // N
};

/// Boards about the held box, some of them there; under `qp` they may rub.
Scene random_scene(std::mt19937& rng, const std::shared_ptr<const TriangleMesh>& body) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Scene scene;
  scene.contact.tick_budget = INFINITY;
  scene.contact.resolver = resolver_kind(kResolvers[rng() % 4]);
  for (int side = 0; side < 6; ++side) {
    if (rng() % 3 == 0) continue;
    const Vec3 out = (side % 2 ? 1.0 : -1.0) * Vec3::Unit(side / 2);
    const Quat q = Quat::FromTwoVectors(Vec3::UnitZ(), out) * rotation(0.2 * Vec3(unit(rng), unit(rng), unit(rng)));
    scene.parts.push_back({"board " + std::to_string(side), kBoard, {q, (0.035 + 0.008 * unit(rng)) * out}});
  }
  scene.parts.push_back({"body", body, Pose(), true});
  if (scene.contact.resolver == ResolverKind::qp && rng() % 2 == 0) scene.friction.mu = 0.4;
  return scene;
}

void look(const Hand& hand, const FclOracle& near, const FclOracle& oracle, bool keeps_out, Counts& counts, bool& air) {
  air = near.intersecting(hand.loop.latest()).empty();
  if (!keeps_out) return;
  for (const Pose& X : hand.loop.report().substeps) counts.intersecting += oracle.intersecting(X).empty() ? 0 : 1;
}

/// `ticks` in one run whose resolver and parts change every 50 ticks or so.
void random_run(std::mt19937& rng, std::int64_t ticks, Counts& counts) {
  const Vec3 size(0.02, 0.015 + 0.01 * static_cast<double>(rng() % 3), 0.025);
  const auto body = shared(box(size));
  Scene scene = random_scene(rng, body), next = scene;
  Hand hand(scene);
  auto oracle = std::make_unique<FclOracle>(scene), near = std::make_unique<FclOracle>(inflated(scene, size));
  std::uniform_real_distribution<double> unit(-1, 1);
  Pose goal;
  std::uint64_t in_force = 0;
  bool air = false;
  for (std::int64_t i = 0; i < ticks; ++i, ++counts.ticks) {
    if (i % 150 == 0)
      goal = {rotation(0.6 * Vec3(unit(rng), unit(rng), unit(rng))), 0.04 * Vec3(unit(rng), unit(rng), unit(rng))};
    if (i > 300 && rng() % 50 == 0) {
      Scene wish = random_scene(rng, body);
      wish.parts.back().pose = hand.loop.latest();
      try {
        hand.loop.change(wish);
        next = wish;            // one that is refused leaves an earlier one that waits
      } catch (const Error&) {  // what it adds stands where the body is
        ++counts.refused;
      }
    }
    const double force = hand.go(wander(rng, hand.device.state.pose, goal)).force.norm();
    counts.felt += force > 1e-3 ? 1 : 0;
    counts.in_air += air ? 1 : 0;
    if (air && force > 1e-3) {
      ++counts.felt_in_air;
      counts.most_in_air = std::max(counts.most_in_air, force);
    }
    if (hand.loop.change_in_force() != in_force) {
      in_force = hand.loop.change_in_force();
      ++counts.changes;
      scene = next;
      oracle = std::make_unique<FclOracle>(scene);
      near = std::make_unique<FclOracle>(inflated(scene, size));
    }
    look(hand, *near, *oracle, scene.contact.resolver != ResolverKind::penalty, counts, air);
  }
}

void check_random_runs(int runs, std::int64_t ticks) {
  Counts counts;
  for (int run = 0; run < runs; ++run) {
    std::mt19937 rng(static_cast<unsigned>(run + 1));
    random_run(rng, ticks, counts);
  }
  std::cout << counts.ticks << " ticks, " << counts.changes << " changes, " << counts.refused << " refused; force in "
            << counts.felt << " ticks, nothing near in " << counts.in_air << ", force there in " << counts.felt_in_air
            << ", at most " << counts.most_in_air << " N; " << counts.intersecting << " poses intersect\n";
  CHECK(counts.felt_in_air == 0);
  CHECK(counts.intersecting == 0);
  CHECK(counts.felt > counts.ticks / 20);
  CHECK(counts.in_air > counts.ticks / 20);
  CHECK(counts.changes > counts.ticks / 500);
}

}  // namespace

TEST_CASE("after a change of the resolver in contact nothing is felt in empty air", "[air]") {
  for (const char* from : kResolvers)
    for (const char* to : kResolvers) {
      CAPTURE(from, to);
      Hand hand(block_over_floor(from, {Quat::Identity(), Vec3(0, 0, 0.03)}));
      lead(hand, Vec3(0, 0, 0.03), 250);  // the force is engaged and ramped in
      CHECK(lead(hand, Vec3(0, 0, 0.007), 200) > 1);
      // A part that springs let into the floor goes over when it has been pulled out.
      Pose free = hand.loop.latest();
      free.p.z() = std::max(free.p.z(), 0.0101);
      const Scene next = block_over_floor(to, free);
      hand.loop.change(next);
      lead(hand, Vec3(0, 0, 0.04), 200);
      REQUIRE(hand.loop.change_in_force() == 1);
      lead(hand, Vec3(0, 0, 0.04), 300);  // what swings comes to rest
      const double across = lead(hand, Vec3(0.06, 0, 0.04), 300), down = lead(hand, Vec3(0.06, 0, 0.03), 300);
      CHECK(across == 0);
      CHECK(down == 0);

      // The report says what that of a loop says that has never known anything else.
      const Pose Y = {Quat::Identity(), Vec3(0.06, 0, 0.03)};
      HapticLoop fresh(block_over_floor(to, Y));
      for (int i = 0; i < 300; ++i) {
        fresh.step(Y, 1e-3);
        hand.loop.step(Y, 1e-3);
      }
      const TickReport &a = hand.loop.report(), &b = fresh.report();
      CHECK(a.substeps.size() == b.substeps.size());
      CHECK((a.proxy.X.p - b.proxy.X.p).norm() < 1e-7);
      CHECK(a.proxy.velocity.v.norm() < 1e-6);
      CHECK(a.proxy.touching == b.proxy.touching);
      CHECK(a.planes.count == b.planes.count);
      CHECK(a.contacts == b.contacts);
      CHECK(a.constraints == b.constraints);
      CHECK(a.gap == b.gap);
      CHECK(a.depth == b.depth);
      CHECK(a.candidate_parts == b.candidate_parts);
      CHECK(a.resolves == b.resolves);
      CHECK(a.iterations == b.iterations);
      CHECK(a.status == b.status);
      CHECK(a.flags.timed_out == b.flags.timed_out);
      CHECK(a.filtered == b.filtered);
      CHECK(a.shrunk == b.shrunk);
      CHECK(a.flags.overflow == b.flags.overflow);
    }
}

TEST_CASE("planes of another pose are not told to the servo", "[air]") {
  Hand hand(block_over_floor("qp", {Quat::Identity(), Vec3(0, 0, 0.03)}));
  lead(hand, Vec3(0, 0, 0.008), 100);
  const TickReport& report = hand.loop.report();
  REQUIRE(report.planes.count > 0);
  tegotae_shm_application told;
  REQUIRE(hand.channel.read(told));
  CHECK(told.plane_count == static_cast<std::uint32_t>(report.planes.count));
  ProxyState elsewhere = report.proxy;
  elsewhere.X.p.z() += 1e-9;
  hand.link.publish(elsewhere, 0, 0, hand.now, report.planes);
  REQUIRE(hand.channel.read(told));
  CHECK(told.plane_count == 0);
}

TEST_CASE("nothing is felt where nothing is near, through changes of resolver and scene", "[air]") {
  check_random_runs(4, 2500);
}

TEST_CASE("the same for a million ticks", "[.][air_long]") {
  check_random_runs(100, 10'000);
}
