// The way by which the part came, backward.
#include <random>

#include "catch.hpp"
#include "loop/trail.hpp"

using namespace tegotae;

namespace {

Pose at(double x, double y) {
  return {Quat::Identity(), Vec3(x, y, 0)};
}

}  // namespace

TEST_CASE("a trail leads back by the poses that the part came by", "[trail]") {
  Trail trail(Vec3::Zero(), 0.1);
  std::mt19937 rng(61);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<Pose> poses = {at(0, 0)};
  for (int i = 0; i < 1000; ++i) {
    const Pose to{Quat(Eigen::AngleAxisd(u(rng), Vec3(u(rng), u(rng), u(rng)).normalized())), Vec3(u(rng), u(rng), 0)};
    trail.went(poses.back(), to);
    poses.push_back(to);
  }
  REQUIRE(trail.count() == Trail::kPoses);
  for (std::size_t i = 0; i < Trail::kPoses; ++i) {
    const Pose& expected = poses[poses.size() - 1 - i];
    CHECK(trail.is_at(expected));
    CHECK(trail.pose(0).p == expected.p);
    trail.go_back();
  }
  CHECK(!trail.is_at(poses.front()));
}

TEST_CASE("a trail has no folds where the part goes back along it, and none of a part that jumped", "[trail]") {
  Trail trail(Vec3::Zero(), 0.1);
  trail.went(at(0, 0), at(1, 0));
  trail.touches({{0, 1, 2}});
  trail.went(at(1, 0), at(1, 1));
  trail.went(at(1, 1), at(1, 3));
  CHECK(trail.count() == 4);
  // Part of the last way, then over a pose.
  trail.went(at(1, 3), at(1, 2));
  CHECK(trail.count() == 4);
  trail.went(at(1, 2), at(1, 0.5));
  REQUIRE(trail.count() == 3);
  CHECK(trail.is_at(at(1, 0.5)));
  CHECK(trail.pose(1).p == Vec3(1, 0, 0));
  CHECK(trail.touched_at(1));
  CHECK(!trail.touched_at(0));
  trail.go_back();
  std::vector<FacePair> touched;
  trail.touched(touched);
  REQUIRE(touched.size() == 1);
  CHECK(touched[0].b == 2);
  // From elsewhere.
  trail.went(at(5, 5), at(6, 5));
  CHECK(trail.count() == 2);
  trail.forget();
  CHECK(trail.count() == 0);
  CHECK(!trail.is_at(at(6, 5)));
}
