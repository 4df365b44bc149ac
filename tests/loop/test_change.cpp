// Scenes that change while they run: parts added, removed, moved, another one held.
#include <time.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <iostream>
#include <mutex>
#include <random>
#include <thread>

#include "alloc_guard.hpp"
#include "bodies.hpp"
#include "catch.hpp"
#include "core/sanitizers.hpp"
#include "fcl_oracle.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::test;
using Catch::Contains;

namespace {

#ifdef TEGOTAE_SANITIZED
constexpr bool kSanitized = true;  // too slow for any budget
#else
constexpr bool kSanitized = false;
#endif

constexpr double kLong = 0.9e-3;  // s of CPU time, budget and 0.1 ms

const auto kBlock = shared(box(Vec3(0.02, 0.02, 0.02)));
const auto kBoard = shared(box(Vec3(0.2, 0.2, 0.01)));

Part board(const std::string& name, const Pose& pose) {
  return {name, kBoard, pose};
}
/// A board whose upper face is at height `z`.
Part floor_at(double z) {
  return board("floor", {Quat::Identity(), Vec3(0, 0, z - 0.005)});
}
/// A board whose face towards -x is at `x`.
Part wall_at(double x) {
  return board("wall", {rotation(Vec3(0, M_PI / 2, 0)), Vec3(x + 0.005, 0, 0)});
}
Part block_at(const Vec3& p) {
  return {"block", kBlock, {Quat::Identity(), p}, true};
}

Scene scene_of(std::vector<Part> parts) {
  Scene scene;
  scene.contact.tick_budget = INFINITY;
  scene.parts = std::move(parts);
  return scene;
}

double thread_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Moves the pen to `to` in a straight line, `ticks` long.
void push(HapticLoop& loop, const Vec3& to, int ticks) {
  const Vec3 from = loop.report().proxy.X.p;
  for (int i = 1; i <= ticks; ++i) loop.step({Quat::Identity(), from + (to - from) * i / ticks}, 1e-3);
}

}  // namespace

TEST_CASE("a part that is added stops the held one, and one that is removed lets it through", "[change]") {
  for (const char* resolver : {"qp", "lp", "impulse", "penalty"}) {
    CAPTURE(resolver);
    Scene scene = scene_of({floor_at(0), block_at(Vec3(0, 0, 0.03))});
    scene.contact.resolver = resolver_kind(resolver);
    // Where springs penetrate: 4 corners with 2000 N/m each against the coupling's 800 N/m over 5 mm.
    const double slack = scene.contact.resolver == ResolverKind::penalty ? 1e-3 : 2e-4;
    HapticLoop loop(scene);
    CHECK(loop.change_in_force() == 0);
    push(loop, Vec3(0, 0, 0.005), 200);
    CHECK(loop.report().proxy.X.p.z() == Approx(0.01).margin(slack));
    CHECK(loop.report().contacts > 0);
    CHECK(loop.latest().p == loop.report().proxy.X.p);
    CHECK(loop.latest().q.coeffs() == loop.report().proxy.X.q.coeffs());

    // Nothing of the floor is left in the first tick without it.
    scene.parts = {wall_at(0.05), scene.parts[1]};
    scene.parts[1].pose = loop.report().proxy.X;
    CHECK(loop.change(scene).number() == 1);
    CHECK(loop.change_in_force() == 0);
    loop.step({Quat::Identity(), Vec3(0, 0, 0.005)}, 1e-3);
    CHECK(loop.change_in_force() == 1);
    CHECK(loop.report().contacts == 0);
    CHECK(loop.constraints().empty());
    push(loop, Vec3(0, 0, -0.05), 200);
    CHECK(loop.report().proxy.X.p.z() == Approx(-0.05).margin(1e-4));

    push(loop, Vec3(0.045, 0, -0.05), 200);
    CHECK(loop.report().proxy.X.p.x() == Approx(0.04).margin(slack));

    // The wall goes back by 10 mm, and the block after it.
    scene.parts[0] = wall_at(0.06);
    scene.parts[1].pose = loop.report().proxy.X;
    CHECK(loop.change(scene).number() == 2);
    push(loop, Vec3(0.055, 0, -0.05), 200);
    CHECK(loop.change_in_force() == 2);
    CHECK(loop.report().proxy.X.p.x() == Approx(0.05).margin(slack));
  }
}

TEST_CASE("a change that would put a part into the held one is refused, and the loop goes on", "[change]") {
  Scene scene = scene_of({floor_at(0), block_at(Vec3(0, 0, 0.03))});
  HapticLoop loop(scene);
  push(loop, Vec3(0, 0, 0.02), 20);
  Scene worse = scene;
  worse.parts.push_back(wall_at(0.005));
  worse.parts[1].pose = loop.report().proxy.X;
  CHECK_THROWS_WITH(loop.change(worse), Contains("\"block\" and \"wall\" intersect"));
  worse.parts.pop_back();
  worse.parts[1].held = false;
  CHECK_THROWS_WITH(loop.change(worse), Contains("no part is held"));
  push(loop, Vec3(0, 0, 0), 100);
  CHECK(loop.change_in_force() == 0);
  CHECK(loop.report().proxy.X.p.z() == Approx(0.01).margin(1e-4));
}

TEST_CASE("a change waits while what it adds is between where the part was and where it is", "[change]") {
  Scene scene = scene_of({floor_at(-0.1), block_at(Vec3(0, 0, 0))});
  HapticLoop loop(scene);
  Scene walled = scene;
  walled.parts.push_back(wall_at(0.02));
  push(loop, Vec3(0.06, 0, 0), 100);  // the part has gone on since
  const SceneChange first = loop.change(walled);
  push(loop, Vec3(0.07, 0, 0), 100);
  CHECK(loop.change_in_force() == 0);
  CHECK(first.state() == ChangeState::pending);
  CHECK(loop.report().proxy.X.p.x() == Approx(0.07).margin(1e-9));
  // A change made later takes its place.
  walled.parts.back() = wall_at(0.03);
  CHECK(loop.change(walled).number() == 2);
  CHECK(first.state() == ChangeState::replaced);
  push(loop, Vec3(0.019, 0, 0), 100);
  CHECK(loop.change_in_force() == 2);
  push(loop, Vec3(0.07, 0, 0), 200);
  CHECK(loop.report().proxy.X.p.x() == Approx(0.02).margin(1e-4));
}

TEST_CASE("a part that springs let into another one is not taken over by a resolver that keeps parts apart",
          "[change]") {
  Scene scene = scene_of({floor_at(0), block_at(Vec3(0, 0, 0.03))});
  scene.contact.resolver = ResolverKind::penalty;
  HapticLoop loop(scene);
  push(loop, Vec3(0, 0, 0), 300);
  REQUIRE(loop.report().proxy.X.p.z() <
          0.0099);  // the block's lower face is 0.1 mm and more under the floor's upper one
  // The same parts, and the held one where it was before it sank in.
  scene.contact.resolver = ResolverKind::qp;
  loop.change(scene);
  push(loop, Vec3(0, 0, 0), 20);
  CHECK(loop.change_in_force() == 0);
  // Pulled out, it is kept out.
  push(loop, Vec3(0, 0, 0.02), 100);
  CHECK(loop.change_in_force() == 1);
  push(loop, Vec3(0, 0, 0), 300);
  CHECK(loop.report().proxy.X.p.z() > 0.01);
}

TEST_CASE("a held part of another shape is asked about everything on its way", "[change]") {
  Scene scene = scene_of({wall_at(0.03), block_at(Vec3(-0.1, 0, 0))});
  HapticLoop loop(scene);
  Scene wider = scene;
  wider.parts[1].mesh = shared(box(Vec3(0.06, 0.02, 0.02)));
  push(loop, Vec3(0.015, 0, 0), 200);  // the wider block would be 15 mm in the wall
  loop.change(wider);
  push(loop, Vec3(0.015, 0, 0), 20);
  CHECK(loop.change_in_force() == 0);
  push(loop, Vec3(-0.05, 0, 0), 200);
  CHECK(loop.change_in_force() == 1);
  push(loop, Vec3(0.03, 0, 0), 200);
  CHECK(loop.report().proxy.X.p.x() == Approx(0).margin(1e-4));
}

TEST_CASE("a change that is not in force can be taken back", "[change]") {
  Scene scene = scene_of({floor_at(0), block_at(Vec3(0, 0, 0.03))});
  auto loop_made = std::make_unique<HapticLoop>(scene);
  HapticLoop& loop = *loop_made;
  Scene empty = scene;
  empty.parts = {scene.parts[1]};
  SceneChange taken_back = loop.change(empty);
  CHECK(taken_back.state() == ChangeState::pending);
  CHECK(taken_back.wait(0.01) == ChangeState::pending);  // nobody steps the loop
  CHECK(taken_back.cancel());
  CHECK_FALSE(taken_back.cancel());
  CHECK(taken_back.state() == ChangeState::canceled);
  push(loop, Vec3(0, 0, 0), 200);
  CHECK(loop.change_in_force() == 0);
  CHECK(loop.report().proxy.X.p.z() == Approx(0.01).margin(1e-4));
  // One in force cannot, and what `ready` throws takes it back too.
  empty.parts[0].pose = loop.report().proxy.X;
  CHECK_THROWS_WITH(loop.change(empty, [](std::uint64_t, const InitialContactReport&) { throw Error("no disk"); }),
                    "no disk");
  std::uint64_t told = 0;
  SceneChange change = loop.change(empty, [&](std::uint64_t n, const InitialContactReport&) { told = n; });
  CHECK(told == change.number());
  push(loop, Vec3(0, 0, -0.01), 200);
  CHECK(loop.change_in_force() == change.number());
  CHECK(change.wait(0) == ChangeState::in_force);
  CHECK_FALSE(change.cancel());
  CHECK(taken_back.state() == ChangeState::canceled);
  CHECK(loop.report().proxy.X.p.z() == Approx(-0.01).margin(1e-6));
  // One that another takes the place of, and one that comes after.
  empty.parts[0].pose = loop.report().proxy.X;
  SceneChange replaced = loop.change(empty);
  SceneChange after = loop.change(empty);
  CHECK(replaced.state() == ChangeState::replaced);
  CHECK_FALSE(replaced.cancel());
  push(loop, Vec3(0, 0, -0.01), 2);
  CHECK(after.state() == ChangeState::in_force);
  CHECK(change.state() == ChangeState::superseded);
  // Handles outlive the loop.
  SceneChange late = loop.change(empty);
  loop_made.reset();
  CHECK(late.wait(0) == ChangeState::replaced);
  CHECK_FALSE(late.cancel());
}

TEST_CASE("a part that comes into the hand and a change right after it: nothing of the old part's pen is left",
          "[change]") {
  // The baselines' coupling damps against the pen's velocity: a jump of 50 mm in a millisecond would throw the part.
  Scene scene = scene_of({block_at(Vec3(0, 0, 0.03)),
                          {"other", kBlock, {Quat::Identity(), Vec3(0.05, 0, 0.03)}},
                          {"bystander", kBlock, {Quat::Identity(), Vec3(0, 0.5, 0)}}});
  scene.contact.resolver = ResolverKind::impulse;
  HapticLoop loop(scene);
  push(loop, Vec3(0, 0, 0.02), 50);
  scene.parts[0].pose = loop.report().proxy.X;
  scene.parts[0].held = false;
  scene.parts[1].held = true;
  loop.change(scene);
  loop.step(scene.parts[0].pose, 1e-3);
  REQUIRE(loop.change_in_force() == 1);
  scene.parts.pop_back();
  loop.change(scene);
  for (int i = 0; i < 20; ++i) {
    loop.step(scene.parts[1].pose, 1e-3);
    CHECK((loop.report().proxy.X.p - scene.parts[1].pose.p).norm() < 1e-6);
  }
  CHECK(loop.change_in_force() == 2);
}

TEST_CASE("another part can be held", "[change]") {
  Scene scene = scene_of({floor_at(0), block_at(Vec3(0, 0, 0.03))});
  scene.parts.push_back({"other", shared(box(Vec3(0.01, 0.03, 0.04))), {Quat::Identity(), Vec3(0.05, 0, 0.03)}});
  HapticLoop loop(scene);
  push(loop, Vec3(0, 0, 0.02), 50);
  scene.parts[1].pose = loop.report().proxy.X;
  scene.parts[1].held = false;
  scene.parts[2].held = true;
  loop.change(scene);
  // In the tick that goes over the pen is still where the block was.
  const TickReport& tick = loop.step(scene.parts[1].pose, 1e-3);
  CHECK(loop.change_in_force() == 1);
  CHECK(tick.proxy.X.p == scene.parts[2].pose.p);
  CHECK(tick.substeps.size() == 1);
  CHECK_FALSE(tick.proxy.touching);
  // And the block is in its way from now on.
  push(loop, Vec3(0, 0, 0.03), 300);
  CHECK(loop.report().proxy.X.p.x() == Approx(0.015).margin(1e-4));
}

TEST_CASE("scenes change from another thread while the loop runs", "[change]") {
  // A box of boards about the block; the changing thread moves two of them and puts posts into the box and out.
  const auto post = shared(box(Vec3(0.005, 0.005, 0.08)));
  std::mt19937 rng(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Scene> scenes;
  for (int k = 0; k < 150; ++k) {
    Scene s = scene_of({});
    s.contact.tick_budget = 0.8e-3;
    const double x = 0.03 + 0.01 * unit(rng), z = 0.03 + 0.01 * unit(rng);
    s.parts = {floor_at(-0.03), wall_at(x), block_at(Vec3::Zero()),
               board("ceiling", {Quat::Identity(), Vec3(0, 0, z + 0.005)}),
               board("left", {rotation(Vec3(0, M_PI / 2, 0)), Vec3(-0.035, 0, 0)})};
    for (int i = 0; i < k % 5; ++i)
      s.parts.push_back({"post " + std::to_string(i),
                         post,
                         {rotation(Vec3(unit(rng), unit(rng), 0)), Vec3(0.03 * unit(rng), i % 2 ? 0.03 : -0.03, 0)}});
    scenes.push_back(std::move(s));
  }
  Scene first = scene_of({floor_at(-0.03), block_at(Vec3::Zero())});
  first.contact.tick_budget = 0.8e-3;
  HapticLoop loop(first);

  // A pen that swings through boards and posts.
  const auto pen = [](std::uint64_t tick) -> Pose {
    const double t = 1e-3 * static_cast<double>(tick);
    return {rotation(Vec3(0.3 * std::sin(3 * t), 0.4 * std::sin(5 * t), 0.2 * std::sin(7 * t))),
            Vec3(0.04 * std::sin(6 * t), 0.01 * std::sin(4 * t), 0.04 * std::sin(9 * t))};
  };
  // How many ticks of 20 000 take long on this machine where nothing changes.
  constexpr std::uint64_t kAlone = 20'000;
  std::uint64_t late_alone = 0;
  {
    HapticLoop alone(scenes[4]);
    for (std::uint64_t i = 0; i < kAlone; ++i) {
      const double begin = thread_seconds();
      alone.step(pen(i), 1e-3);
      late_alone += thread_seconds() - begin > kLong ? 1 : 0;
    }
  }

  std::atomic<bool> over{false};
  std::mutex mutex;  // of X and the scenes that were accepted, by number
  Pose lately;
  std::vector<Scene> accepted = {first};
  std::atomic<std::uint64_t> offered{0};  // scenes, also those that were refused
  std::atomic<int> refused{0};
  std::thread changer([&] {
    for (std::size_t k = 0; !over; k = (k + 1) % scenes.size()) {
      Scene next = scenes[k];
      {
        const std::lock_guard<std::mutex> lock(mutex);
        for (Part& p : next.parts)
          if (p.held) p.pose = lately;
      }
      try {
        const std::uint64_t number = loop.change(next).number();
        const std::lock_guard<std::mutex> lock(mutex);
        accepted.resize(std::max<std::size_t>(accepted.size(), number + 1));
        accepted[number] = next;
      } catch (const Error&) {
        ++refused;
      }
      ++offered;
    }
  });

  struct Tick {
    std::uint64_t change;
    Pose X;
  };
  // Until enough changes went into force. With a sanitizer a scene takes a second to be made ready.
  constexpr std::uint64_t kChanges = kSanitized ? 30 : 60;
  constexpr std::size_t kMaxPoses = 1'000'000;
  // The loop makes so many ticks while one scene is made ready, and then waits: how many ticks all changes take does
  // not depend on how fast the machine makes scenes ready.
  constexpr std::uint64_t kTicksPerScene = 1000;
  std::vector<Tick> poses;
  poses.reserve(kMaxPoses);
  std::uint64_t allocations = 0, changes = 0, ticks = 0, late = 0;
  for (; changes < kChanges && poses.size() < kMaxPoses - 100; ++ticks) {
    while (ticks > kTicksPerScene * (offered + 1)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const Pose Y = pen(ticks);
    const std::uint64_t before = loop.change_in_force();
    const double begin = thread_seconds();
    {
      const AllocGuard guard;
      loop.step(Y, 1e-3);
      if (ticks > 100) allocations += guard.count();
    }
    late += thread_seconds() - begin > kLong ? 1 : 0;
    const std::uint64_t now = loop.change_in_force();
    changes += now != before ? 1 : 0;
    for (const Pose& X : loop.report().substeps) poses.push_back({now, X});
    const std::lock_guard<std::mutex> lock(mutex);
    lately = loop.report().proxy.X;
  }
  over = true;
  changer.join();

  std::size_t intersecting = 0;
  std::uint64_t number = ~std::uint64_t{0};
  std::unique_ptr<FclOracle> oracle;
  for (const Tick& tick : poses) {
    REQUIRE(tick.change < accepted.size());
    if (tick.change != number) {
      number = tick.change;
      oracle = std::make_unique<FclOracle>(accepted[number]);
    }
    intersecting += oracle->intersecting(tick.X).empty() ? 0 : 1;
  }
  std::cout << changes << " changes went into force in " << ticks << " ticks, " << refused << " were refused, " << late
            << " ticks over 0.9 ms of CPU time\n";
  CHECK(changes == kChanges);
  CHECK(intersecting == 0);
  CHECK(allocations == 0);
  // A change takes no more of a tick than a share of its budget: ticks are late as without, and one in a thousand more.
  if (!kSanitized) CHECK(late <= ticks / 1000 + 2 * late_alone * (ticks / kAlone + 1));
}
