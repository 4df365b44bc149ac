// Threads and bores that parts have in common, and what moves along them.
#include "catch.hpp"
#include "models/puzzles.hpp"
#include "plan/common_axes.hpp"
#include "plan/motion_world.hpp"

using namespace tegotae;

namespace {

constexpr double kTurn = 6.283185307179586;

}  // namespace

TEST_CASE("a screw in its nut has the axis and the rise of its thread") {
  const shapes::Puzzle p = shapes::puzzle("screw");
  const std::vector<CommonAxis> axes = common_axes(p.scene(), p.start);
  REQUIRE(!axes.empty());
  const CommonAxis& axis = axes.front();
  CHECK(axis.direction.cross(Vec3::UnitZ()).norm() < 1e-3);
  // Its known way turns about z, a sixth of a turn from one pose to the next.
  const double sense = axis.direction.z() > 0 ? 1 : -1;
  const Pose next = axis.turned(p.start, sense * kTurn / 6);
  CHECK((next.p - p.known[1].p).norm() < 20e-6);
  CHECK(next.q.angularDistance(p.known[1].q) < 1e-3);
  CHECK(axis.distance(p.start, {0.003, 0.004, 0.01}) == Approx(0.005).epsilon(0.02));
  CHECK((axis.shifted(p.start, 0.01).p - p.start.p).norm() == Approx(0.01));
}

TEST_CASE("parts beside each other have no axis in common") {
  const shapes::Puzzle p = shapes::puzzle("screw");
  CHECK(common_axes(p.scene(), {Quat::Identity(), {0.004, 0, 0}}).empty());
  CHECK(common_axes(p.scene(), {Quat::Identity(), {0, 0, 0.05}}).empty());
  CHECK(common_axes(p.scene(), {Quat(Eigen::AngleAxisd(0.3, Vec3::UnitX())), Vec3::Zero()}).empty());
}

TEST_CASE("a straight way is proved before the contact loop is made") {
  const shapes::Puzzle p = shapes::puzzle("straight");
  MotionWorld world(p.scene(), kGapFloor);
  CHECK(!world.is_complete());
  CHECK(world.is_free(p.start, p.known.back()));
  Pose aside = p.start;
  aside.p.x() += 1e-3;
  CHECK(!world.is_free(p.start, aside));
  CHECK(!world.is_complete());
  std::vector<Pose> pieces;
  world.comply(p.start, aside, 1e-3, pieces);
  CHECK(world.is_complete());
}
