// Threads that share the work of a tick: how many there are, when, and that nothing else changes.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>
#include <utility>

#include "alloc_guard.hpp"
#include "bodies.hpp"
#include "catch.hpp"
#include "fcl_oracle.hpp"
#include "models/height_field.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

std::shared_ptr<const TriangleMesh> waves(int n, double size) {
  return shared(shapes::sheet({size, size, n, n}, shapes::waves(0.04 * size, 0.5 * size)));
}

Scene sheet_over_die(int n, std::optional<int> helpers, double height = 0.002, double size = 0.1) {
  Scene scene;
  scene.contact.helper_threads = helpers;
  scene.parts = {{"die", waves(n + 13, size), Pose()},
                 {"sheet", waves(n, size), {Quat::Identity(), {0, 0, height}}, true}};
  return scene;
}

/// Helpers of this process.
int helpers() {
  int count = 0;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::string name;
    std::getline(std::ifstream(task.path() / "comm"), name);
    count += name == "tegotae-helper";
  }
  return count;
}

/// Whether there are so many. One that has ended may still be shown for a moment.
bool are_helpers(int count) {
  for (int i = 0; i < 2000 && helpers() > count; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return helpers() == count;
}

/// Lowers a sheet of so many meters on its die with so little time (s) a tick, and looks at the contacts of the ticks
/// in which it stands farther above than contacts are else. How many there were.
int ticks_held_above(double size, double tick_budget) {
  Scene scene = sheet_over_die(90, 0, 0.02 * size, size);
  scene.contact.tick_budget = tick_budget;
  HapticLoop loop(scene);
  // Sheet and die are the same waves: along the normal they are as far apart as the sheet is high times the cosine of
  // the slope (up to 0.5), but for what edges cut off, which are 0.011 of its size.
  constexpr double kCos = 0.89;
  const double sagittas = 4e-4 * size;
  // What holds it is no farther off than 0.15 % of its radius.
  const double radius = 1.01 * size / std::sqrt(2.0), near_gap = 1.5e-3 * radius;
  int far_off = 0;
  Pose before;
  for (int tick = 0; tick < 600; ++tick) {
    const Pose Y = {Quat::Identity(), {0, 0, size * std::max(-0.03, 0.02 - 5e-4 * tick)}};
    const TickReport& r = loop.step(Y, 1e-3);
    const Pose X = r.proxy.X;
    // Where it moves, contacts may be those of the pose before.
    const bool stands = X.p == std::exchange(before, X).p;
    if (!stands || r.contacts == 0 || r.gap <= *loop.contact().l_min) continue;
    ++far_off;
    CHECK(r.lag > std::min(loop.lag_bound(), near_gap));
    CHECK(r.gap <= near_gap);
    // What holds it may have turned it aside.
    const double aside = X.p.head<2>().norm() + radius * rotation_vector(X.q).norm();
    CHECK(r.gap < X.p.z() + sagittas + aside);
    CHECK(r.gap > kCos * X.p.z() - sagittas - aside);
    CHECK(r.proxy.touching);
    bool in_the_way = false;
    for (const ContactPoint& c : loop.contacts()) {
      CHECK((c.point_a - c.point_b).norm() == Approx(c.gap).margin(1e-9));
      // Where the pen wants the point is beyond the other surface.
      in_the_way = in_the_way || c.normal.dot(Y * (X.inverse() * c.point_a) - c.point_b) < 0;
    }
    CHECK(in_the_way);
  }
  return far_off;
}

}  // namespace

TEST_CASE("there are as many helpers as are asked for, where a tick has an end and the part is large") {
  {
    const HapticLoop loop(sheet_over_die(60, 3));
    CHECK(are_helpers(3));
    CHECK(loop.contact().helper_threads == 3);
  }
  CHECK(are_helpers(0));
  {
    const HapticLoop none(sheet_over_die(60, 0)), small(sheet_over_die(10, 3));
    CHECK(are_helpers(0));
    Scene scene = sheet_over_die(60, 3);
    scene.contact.tick_budget = INFINITY;
    const HapticLoop virtual_time(scene);
    CHECK(are_helpers(0));
  }
  const HapticLoop loop(sheet_over_die(60, {}));
  REQUIRE(loop.contact().helper_threads.has_value());
  CHECK(*loop.contact().helper_threads <= 7);
  CHECK(*loop.contact().helper_threads < static_cast<int>(std::thread::hardware_concurrency()));
  CHECK(are_helpers(*loop.contact().helper_threads));
}

TEST_CASE("a number of helpers that cannot be is refused") {
  for (const int helpers : {-1, ContactSettings::kMostHelpers + 1}) {
    try {
      const HapticLoop loop(sheet_over_die(10, helpers));
      FAIL("accepted " << helpers);
    } catch (const Error& e) {
      CHECK(e.kind() == ErrorKind::setting);
      CHECK(e.place().key == "contact.helper_threads");
      CHECK_THAT(e.what(), Catch::Matchers::Contains("from 0 to 64"));
    }
  }
}

TEST_CASE("with helpers a sheet comes down on its die, slides and comes off, and never enters it") {
  Scene scene = sheet_over_die(90, 2);
  scene.contact.tick_budget = 1e-4;  // too short for one thread
  HapticLoop loop(scene);
  const FclOracle oracle(scene);
  const auto pen = [](int tick) -> Pose {
    const double t = 1e-3 * tick;
    const double down = tick < 700 ? 0.002 - 0.01 * t : -0.005 + 0.05 * (t - 0.7);
    return {rotation({0, 0, 0.02 * std::sin(9 * t)}), {0.002 * std::sin(7 * t), 0.002 * std::cos(5 * t), down}};
  };
  std::uint64_t allocations = 0;
  int touching = 0, intersecting = 0;
  for (int tick = 0; tick < 1000; ++tick) {
    const Pose Y = pen(tick);
    const AllocGuard guard;
    const TickReport& r = loop.step(Y, 1e-3);
    allocations += guard.count();
    touching += r.proxy.touching;
    if (tick % 10 == 0) intersecting += static_cast<int>(oracle.intersecting(r.proxy.X).size());
  }
  CHECK(allocations == 0);
  CHECK(touching > 50);
  CHECK(intersecting == 0);
  // However slow the machine is.
  const Pose away = {Quat::Identity(), {0, 0, 0.02}};
  int ticks = 0;
  while (ticks < 20000 && (loop.step(away, 1e-3).proxy.X.p - away.p).norm() > 1e-6) ++ticks;
  CHECK(ticks < 20000);
}

TEST_CASE("what is in the way of a part that is out of time is a contact, a little farther off than others") {
  const double size = GENERATE(0.1, 1.0);
  // A tick with which it waits above its seat: long enough to know what is near, too short for a look at all of it. How
  // long that is depends on the machine; from one length to four times as much it is so on all of them.
  int far_off = 0;
  for (const double tick_budget : {1e-4, 4e-4, 1.6e-3, 6.4e-3}) {
    if (far_off == 0) far_off = ticks_held_above(size, tick_budget);
  }
  CHECK(far_off > 0);
}

TEST_CASE("a scene that changes has helpers, too, and those of the one before the last are gone") {
  static constexpr double kFarOff = 0.3;
  HapticLoop loop(sheet_over_die(60, 2, kFarOff));
  const auto change = [&loop](int n, int threads) {
    const SceneChange changed = loop.change(sheet_over_die(n, threads, kFarOff));
    loop.step({Quat::Identity(), {0, 0, kFarOff}}, 1e-3);
    REQUIRE(changed.state() == ChangeState::in_force);
  };
  change(70, 1);
  CHECK(are_helpers(3));
  change(60, 0);
  CHECK(are_helpers(1));
}
