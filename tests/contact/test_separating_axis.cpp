#include <algorithm>
#include <vector>

#include "bodies.hpp"
#include "catch.hpp"
#include "contact/separating_axis.hpp"
#include "feature/simplex_distance.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

/// By the definition: of all axes that separate the triangles, the most that one leaves when A has moved. The axes: the
/// normals, the cross products of edges, the direction between the closest points, each both ways.
double best_by_definition(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                          const std::array<Vec3, 3>& motion) {
  std::vector<Vec3> axes;
  const ClosestPoints c = closest_points({3, a}, {3, b});
  axes.push_back(c.a - c.b);
  for (const auto& t : {a, b}) axes.push_back((t[1] - t[0]).cross(t[2] - t[0]));
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) axes.push_back((a[(i + 1) % 3] - a[i]).cross(b[(k + 1) % 3] - b[k]));
  double best = -1e300;
  for (const Vec3& axis : axes) {
    if (axis.norm() < 1e-6) continue;  // parallel edges of random triangles do not come up
    for (const double sign : {1.0, -1.0}) {
      const Vec3 n = sign * axis.normalized();
      double before = 1e300, after = 1e300, side = -1e300;
      for (int k = 0; k < 3; ++k) {
        side = std::max(side, n.dot(b[k]));
        before = std::min(before, n.dot(a[k]));
        after = std::min(after, n.dot(a[k] + motion[k]));
      }
      if (before >= side) best = std::max(best, after - side);
    }
  }
  return best;
}

}  // namespace

TEST_CASE("of all separating axes the one that leaves most is taken, also for turning motions", "[contact]") {
  std::mt19937 rng(32);
  int apart = 0;
  for (int i = 0; i < 3000; ++i) {
    std::array<Vec3, 3> a, b, motion;
    const Vec3 shift = random_vector(rng, 1.5), move = random_vector(rng, 0.5), turn = random_vector(rng, 0.3);
    for (int k = 0; k < 3; ++k) {
      a[k] = random_vector(rng, 1.0) + shift;
      b[k] = random_vector(rng, 1.0);
      motion[k] = move + turn.cross(a[k]);
    }
    const double best = best_by_definition(a, b, motion);
    const AxisLimit axis = least_limiting_axis(a, b, motion, 0);
    REQUIRE(axis.found == (best > -1e300));
    if (!axis.found) continue;
    ++apart;
    double end = 1e300, side = -1e300;
    for (int k = 0; k < 3; ++k) {
      side = std::max(side, axis.n.dot(b[k]));
      end = std::min(end, axis.n.dot(a[k] + motion[k]));
    }
    REQUIRE(end - side == Approx(best).margin(1e-9));
  }
  REQUIRE(apart > 1000);
}

TEST_CASE("the axis separates, its corner carries the limit, and no axis passes the true distance", "[contact]") {
  std::mt19937 rng(31);
  int apart = 0;
  for (int i = 0; i < 3000; ++i) {
    std::array<Vec3, 3> a, b, motion;
    const Vec3 shift = random_vector(rng, 1.5), move = random_vector(rng, 0.5);
    for (int k = 0; k < 3; ++k) {
      a[k] = random_vector(rng, 1.0) + shift;
      b[k] = random_vector(rng, 1.0);
      motion[k] = move;  // a translation, for which the best axis at the end pose is known by sampling
    }
    const AxisLimit axis = least_limiting_axis(a, b, motion, 0);
    if (!axis.found) continue;
    ++apart;
    REQUIRE(axis.n.norm() == Approx(1.0));
    const double side = std::max({axis.n.dot(b[0]), axis.n.dot(b[1]), axis.n.dot(b[2])});
    for (const Vec3& p : a) REQUIRE(axis.n.dot(p) - side >= 0);
    REQUIRE(axis.n.dot(a[axis.corner]) - side == Approx(axis.gap).margin(1e-12));
    double end = 1e300;
    for (int k = 0; k < 3; ++k) end = std::min(end, axis.n.dot(a[k] + motion[k]) - side);
    REQUIRE(axis.n.dot(a[axis.corner] + motion[axis.corner]) - side == Approx(end).margin(1e-12));
    // When the triangles are free at the end too and translate, some axis found leaves a gap or nearly so: the true
    // distance is an upper bound that no axis can pass.
    Simplex ea{3, a};
    for (int k = 0; k < 3; ++k) ea.p[k] += motion[k];
    REQUIRE(end <= std::sqrt(closest_points(ea, {3, b}).squared_distance) + 1e-12);
  }
  REQUIRE(apart > 1000);
}

TEST_CASE("coplanar neighbors are separated along the plane and flat pairs along the normal", "[contact]") {
  const std::array<Vec3, 3> b{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  std::array<Vec3, 3> a = b;
  for (Vec3& p : a) p.z() += 0.01;
  const std::array<Vec3, 3> down{Vec3(0, 0, -0.02), Vec3(0, 0, -0.02), Vec3(0, 0, -0.02)};
  const AxisLimit flat = least_limiting_axis(a, b, down, 0);
  REQUIRE(flat.found);
  REQUIRE(flat.n.z() == Approx(1.0));
  REQUIRE(flat.gap == Approx(0.01));
}
