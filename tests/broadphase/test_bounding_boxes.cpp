#include "broadphase/bounding_boxes.hpp"

#include <random>

#include "catch.hpp"

using namespace tegotae;

namespace {

class Draw {
 public:
  double number(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(rng_); }
  Vec3 vector(double s) { return {number(-s, s), number(-s, s), number(-s, s)}; }
  Pose pose(double s) { return {rotation(vector(2)), vector(s)}; }
  Box box() { return {vector(0.1), {number(0, 0.1), number(0, 0.1), number(0, 0.1)}}; }
  Vec3 point(const Box& b) { return b.center + b.half.cwiseProduct(vector(1)); }

 private:
  std::mt19937 rng_{11};
};

bool is_kept(const Box& a, const Pose& X_a, const Box& b, const Pose& X_b, double distance) {
  BoundingBoxes boxes;
  boxes.add(b, X_b);
  std::vector<std::uint32_t> near = {0};
  boxes.keep_near(a, X_a, distance, near);
  return !near.empty();
}

/// The corner of the box that is farthest along a unit vector of the world.
Vec3 corner(const Box& b, const Pose& X, const Vec3& n) {
  const Vec3 n_F = X.q.conjugate() * n;
  Vec3 p = b.center;
  for (int i = 0; i < 3; ++i) p[i] += n_F[i] < 0 ? -b.half[i] : b.half[i];
  return X * p;
}

}  // namespace

TEST_CASE("no box with a point within the distance is left out", "[broadphase]") {
  Draw draw;
  for (int round = 0; round < 2000; ++round) {
    Box boxes[2] = {draw.box(), draw.box()};
    Pose X[2] = {draw.pose(5), draw.pose(5)};
    const int face = round % 2, other = 1 - face;
    // A corner of the other box is over the middle of a face, so nothing is nearer than the gap.
    const Vec3 n_F = (round % 3 == 0 ? -1 : 1) * Vec3::Unit(round % 3), n = X[face].q * n_F;
    const double gap = draw.number(0.001, 0.1);
    const Vec3 middle = X[face] * (boxes[face].center + n_F.cwiseProduct(boxes[face].half));
    X[other].p += middle + gap * n - corner(boxes[other], X[other], -n);
    REQUIRE(is_kept(boxes[0], X[0], boxes[1], X[1], gap + 1e-9));
    REQUIRE_FALSE(is_kept(boxes[0], X[0], boxes[1], X[1], gap - 1e-9));
  }
}

TEST_CASE("boxes keep the order of what is near", "[broadphase]") {
  BoundingBoxes boxes;
  const Box box{Vec3::Zero(), {0.1, 0.1, 0.1}};
  for (int i = 0; i < 10; ++i) boxes.add(box, {Quat::Identity(), Vec3(i, 0, 0)});
  std::vector<std::uint32_t> near = {1, 3, 4, 5, 9};
  boxes.keep_near(box, {Quat::Identity(), Vec3(4, 0, 0)}, 0.81, near);
  REQUIRE(near == std::vector<std::uint32_t>{3, 4, 5});
}
