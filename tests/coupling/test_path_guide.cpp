// The pull of a guide along a path: its closed forms, its bound, and how it lets go and comes back.
#include <cmath>
#include <random>

#include "alloc_guard.hpp"
#include "bodies.hpp"
#include "catch.hpp"
#include "coupling/path_guide.hpp"
#include "tegotae/core/error.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr double kTick = 1e-3;
constexpr double kGuideRadius = 0.02;  // √(k_t / k)

PathGuideSettings settings(double scale = 1) {
  PathGuideSettings s;
  s.coupling.stiffness = 1000;
  s.coupling.torsional_stiffness = 1000 * kGuideRadius * kGuideRadius;
  s.scale = scale;
  s.center = Vec3(0.001, -0.002, 0.003);
  s.force = 0.8;
  return s;
}

/// The center of mass at `c`, turned by `turn`.
Pose placed(const Vec3& c, const Vec3& turn = Vec3::Zero()) {
  const Quat q = rotation(turn);
  return {q, c - q * settings().center};
}

/// 100 mm along x.
std::vector<Pose> straight(double scale = 1, int parts = 1) {
  std::vector<Pose> path;
  for (int i = 0; i <= parts; ++i) path.push_back(placed(Vec3(scale * 0.1 * i / parts, 0, 0)));
  return path;
}

/// The pull when the guide has come after a hand that was put to `Y` at a stroke.
Wrench settled(PathGuide& guide, const Pose& Y) {
  for (int i = 0; i < 1000; ++i) guide.pull(Y, kTick);
  return guide.pull(Y, kTick);
}

}  // namespace

TEST_CASE("along a straight path the pull is its force, along it and back to it", "[guide]") {
  const double scale = GENERATE(1.0, 3.0, 0.1);
  const int parts = GENERATE(1, 7, 500);
  PathGuide guide(straight(scale, parts), settings(scale));
  CHECK(guide.length() == Approx(0.1));
  const double soft = PathGuide::kSoft;
  for (const double off : {0.0, 0.002, -0.006, 0.0099}) {
    const Wrench w = settled(guide, placed(scale * Vec3(0.03, off, 0)));
    const double far = std::hypot(soft, off);
    CHECK((w.force - 0.8 / far * Vec3(soft, -off, 0)).norm() < 1e-9);
    CHECK(w.torque.norm() < 1e-9);
    CHECK(guide.distance() == Approx(std::abs(off)).margin(1e-9));
    CHECK(guide.along() == Approx(0.03).margin(1e-9));
  }
  // Turned by 0.3 rad: 6 mm of turn at the radius.
  const Wrench w = settled(guide, placed(scale * Vec3(0.03, 0, 0), Vec3(0, 0, 0.3)));
  const double far = std::hypot(soft, 0.3 * kGuideRadius);
  CHECK((w.force - 0.8 / far * Vec3(soft, 0, 0)).norm() < 1e-9);
  CHECK((w.torque - 0.8 / far * kGuideRadius * Vec3(0, 0, -0.3 * kGuideRadius)).norm() < 1e-9);
}

TEST_CASE("before a corner the pull goes on to it, and from it on", "[guide]") {
  PathGuide guide({placed(Vec3::Zero()), placed(Vec3(0.03, 0, 0)), placed(Vec3(0.03, 0, 0.04))}, settings());
  for (const double before : {0.01, 1e-3, 1e-5}) {
    const Wrench w = settled(guide, placed(Vec3(0.03 - before, 0, 0)));
    CHECK((w.force - Vec3(0.8, 0, 0)).norm() < 1e-9);
  }
  // At the corner and a little too far: up.
  for (const double over : {0.0, 1e-5, 1e-4}) {
    const Wrench w = settled(guide, placed(Vec3(0.03 + over, 0, 0)));
    CHECK((w.force - Vec3(0, 0, 0.8)).norm() < 0.02);
  }
}

TEST_CASE("near the end of the path the pull is a spring to there", "[guide]") {
  PathGuide guide(straight(), settings());
  for (const double left : {0.006, 0.001, 0.0, -0.004}) {  // before and behind the end
    const Wrench w = guide.pull(placed(Vec3(0.1 - left, 0, 0)), kTick);
    CHECK((w.force - Vec3(0.8 * left / PathGuide::kSoft, 0, 0)).norm() < 1e-9);
  }
}

TEST_CASE("a turn in place is pulled by torque alone", "[guide]") {
  const Vec3 axis = Vec3(1, 2, -1).normalized();
  std::vector<Pose> path;
  for (int i = 0; i <= 20; ++i) path.push_back(placed(Vec3(0.01, 0.02, 0.03), 0.1 * i * axis));
  PathGuide guide(path, settings());
  CHECK(guide.length() == Approx(2 * kGuideRadius));
  const Wrench w = guide.pull(placed(Vec3(0.01, 0.02, 0.03), 0.73 * axis), kTick);
  CHECK(w.force.norm() < 1e-9);
  CHECK((w.torque - 0.8 * kGuideRadius * axis).norm() < 1e-9);
  CHECK(guide.torque() == Approx(0.8 * kGuideRadius));
}

TEST_CASE("a screw is followed through poses that come again", "[guide]") {
  // Four turns with a pitch of 0.5 mm: a turn farther is 0.5 mm away, the way there 126 mm.
  std::vector<Pose> path;
  const auto at = [](double turns) {
    return placed(Vec3(0, 0, 5e-4 * turns), Vec3(0, 0, std::remainder(2 * M_PI * turns, 2 * M_PI)));
  };
  for (int i = 0; i <= 400; ++i) path.push_back(at(0.01 * i));
  PathGuide guide(path, settings());
  const double a_turn = std::hypot(5e-4, 2 * M_PI * kGuideRadius);
  CHECK(guide.length() == Approx(4 * a_turn).epsilon(1e-6));
  for (int i = 0; i <= 1600; ++i) {
    const double turns = 3.8 * std::sin(M_PI / 2 * i / 800);  // there and back
    const Wrench w = guide.pull(at(turns), kTick);
    REQUIRE(guide.along() == Approx(turns * a_turn).margin(1e-6));
    REQUIRE(w.torque.z() > 0.99 * 0.8 * kGuideRadius);  // always on
  }
}

TEST_CASE("the pull is never more than its force, and nothing beyond its reach", "[guide]") {
  std::mt19937 rng(22);
  std::vector<Pose> path;
  Pose at = placed(Vec3::Zero());
  for (int i = 0; i < 300; ++i) {
    path.push_back(at);
    at = displaced(at, settings().center, {random_vector(rng, 2e-3), random_vector(rng, 0.05)});
  }
  PathGuide guide(path, settings());
  std::uniform_int_distribution<std::size_t> any(0, path.size() - 1);
  int near = 0, far = 0;
  std::uint64_t allocations = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double size = i % 2 == 0 ? 0.005 : 0.05;
    const Pose Y = displaced(path[any(rng)], settings().center, {random_vector(rng, size), random_vector(rng, 0.5)});
    const AllocGuard guard;
    const Wrench w = guide.pull(Y, kTick);
    allocations += guard.count();
    const double pull = std::hypot(w.force.norm(), w.torque.norm() / kGuideRadius);
    REQUIRE(pull <= 0.8 * (1 + 1e-12));
    if (guide.distance() >= PathGuide::kReach) REQUIRE(pull == 0);
    ++(guide.distance() < PathGuide::kReach ? near : far);
  }
  CHECK(allocations == 0);
  CHECK(near > 1000);
  CHECK(far > 1000);
}

TEST_CASE("a hand that leaves is let go, and pulled again when it is back, without a jump", "[guide]") {
  PathGuide guide(straight(), settings());
  double last = guide.pull(placed(Vec3(0.05, 0, 0)), kTick).force.norm();
  CHECK(last == Approx(0.8));  // whoever has the pen lets it grow
  const auto go = [&](double from, double to) {
    for (int i = 1; i <= 300; ++i) {
      const double off = from + (to - from) * i / 300;
      const double force = guide.pull(placed(Vec3(0.05, off, 0)), kTick).force.norm();
      REQUIRE(std::abs(force - last) < 0.02);
      if (off > PathGuide::kReach + 1e-9) REQUIRE(force == 0);
      last = force;
    }
  };
  go(0, 0.03);
  CHECK(last == 0);
  // At a stroke it is back at another place: the pull comes over 0.3 s.
  for (int i = 1; i <= 300; ++i) {
    const double force = guide.pull(placed(Vec3(0.02, 0, 0)), kTick).force.norm();
    REQUIRE(force == Approx(0.8 * i / 300));
  }
}

TEST_CASE("a hand far along a long path is found", "[guide]") {
  PathGuide guide(straight(1, 5000), settings());
  // In 64 of the 5000 pieces a tick, and from there by 16 a tick.
  const Wrench w = settled(guide, placed(Vec3(0.09, 0, 0)));
  CHECK(guide.along() == Approx(0.09));
  CHECK((w.force - Vec3(0.8, 0, 0)).norm() < 1e-6);
}

TEST_CASE("a path needs a pose, and one is enough", "[guide]") {
  CHECK_THROWS_WITH(PathGuide({}, settings()), "guide: a path needs a pose");
  PathGuide guide({placed(Vec3(0, 0, 0.01))}, settings());
  CHECK((guide.pull(placed(Vec3(0, 0, 0.006)), kTick).force - Vec3(0, 0, 0.4)).norm() < 1e-9);
}
