#include <fcl/narrowphase/detail/primitive_shape_algorithm/triangle_distance.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "bodies.hpp"
#include "catch.hpp"
#include "feature/simplex_distance.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

bool on_simplex(const Vec3& p, const Simplex& s, unsigned mask) {
  // The point must be a convex combination of just the corners in the mask: least squares over barycentrics.
  std::vector<Vec3> c;
  for (int k = 0; k < s.size; ++k)
    if (mask & (1u << k)) c.push_back(s.p[k]);
  if (c.size() == 1) return (p - c[0]).norm() < 1e-12;
  Eigen::MatrixXd A(3, c.size() - 1);
  for (std::size_t k = 1; k < c.size(); ++k) A.col(k - 1) = c[k] - c[0];
  const Eigen::VectorXd t = A.colPivHouseholderQr().solve(Eigen::VectorXd(p - c[0]));
  return (A * t - (p - c[0])).norm() < 1e-11 && t.minCoeff() > -1e-12 && t.sum() < 1 + 1e-12;
}

}  // namespace

TEST_CASE("triangle distances agree with FCL's triangle distance", "[feature]") {
  std::mt19937 rng(11);
  fcl::detail::TriangleDistance<double> oracle;
  int compared = 0;
  for (int i = 0; i < 20000; ++i) {
    Simplex a{3, {}}, b{3, {}};
    const Vec3 shift = random_vector(rng, 2.0);
    for (int k = 0; k < 3; ++k) {
      a.p[k] = random_vector(rng, 1.0);
      b.p[k] = random_vector(rng, 1.0) + shift;
    }
    Vec3 p, q;
    const Vec3 fa[3] = {a.p[0], a.p[1], a.p[2]}, fb[3] = {b.p[0], b.p[1], b.p[2]};
    const double expected = oracle.triDistance(fa, fb, p, q);
    if (expected == 0) continue;  // crossing triangles are outside the contract
    ++compared;
    const ClosestPoints c = closest_points(a, b);
    REQUIRE(std::sqrt(c.squared_distance) == Approx(expected).epsilon(1e-9));
    REQUIRE(on_simplex(c.a, a, c.mask_a));
    REQUIRE(on_simplex(c.b, b, c.mask_b));
    REQUIRE((c.a - c.b).squaredNorm() == Approx(c.squared_distance).epsilon(1e-12));
  }
  REQUIRE(compared > 10000);
}

TEST_CASE("points and segments are simplices too", "[feature]") {
  const ClosestPoints face =
      closest_points({1, {Vec3(0.2, 0.2, 0.5)}}, {3, {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}});
  REQUIRE(face.squared_distance == Approx(0.25));
  REQUIRE(face.mask_b == 7);
  const ClosestPoints past = closest_points({1, {Vec3(2, 0, 0)}}, {2, {Vec3(0, 0, 0), Vec3(1, 0, 0)}});
  REQUIRE(past.squared_distance == Approx(1.0));
  REQUIRE(past.mask_b == 2);
  const ClosestPoints cross =
      closest_points({2, {Vec3(-1, 0, 1), Vec3(1, 0, 1)}}, {2, {Vec3(0, -1, 0), Vec3(0, 1, 0)}});
  REQUIRE(cross.squared_distance == Approx(1.0));
  REQUIRE(cross.mask_a == 3);
  REQUIRE(cross.mask_b == 3);
  const ClosestPoints parallel =
      closest_points({2, {Vec3(0, 0, 1), Vec3(1, 0, 1)}}, {2, {Vec3(0.5, 0, 0), Vec3(2, 0, 0)}});
  REQUIRE(parallel.squared_distance == Approx(1.0));
}

TEST_CASE("degenerate triangles have a distance", "[feature]") {
  const Simplex needle{3, {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 0, 0)}};
  const Simplex point{3, {Vec3(0.3, 0, 2), Vec3(0.3, 0, 2), Vec3(0.3, 0, 2)}};
  REQUIRE(closest_points(needle, point).squared_distance == Approx(4.0));
}

TEST_CASE("edges that are closest inside both are told from the others", "[feature]") {
  // Against a search over the square of the two places: its minimum lies inside, or at the rim.
  std::mt19937 rng(12);
  std::uniform_real_distribution<double> flat(0, 1);
  int inside = 0, outside = 0;
  for (int i = 0; i < 3000; ++i) {
    Simplex a{2, {}}, b{2, {}};
    const double scale = std::pow(10.0, -4 * flat(rng));
    a.p[0] = scale * random_vector(rng, 1.0);
    a.p[1] = a.p[0] + scale * random_vector(rng, 1.0);
    b.p[0] = scale * random_vector(rng, 1.0);
    // Every third is nearly parallel.
    b.p[1] = b.p[0] + (i % 3 == 0 ? Vec3(a.p[1] - a.p[0] + 0.01 * scale * random_vector(rng, 1.0))
                                  : Vec3(scale * random_vector(rng, 1.0)));
    const auto squared = [&](double s, double t) {
      return (a.p[0] + s * (a.p[1] - a.p[0]) - b.p[0] - t * (b.p[1] - b.p[0])).squaredNorm();
    };
    double s = 0.5, t = 0.5, step = 0.25;
    // The distance is convex in the two places, so that a search by ever smaller steps ends at its minimum.
    for (int k = 0; k < 4000 && step > 1e-9; ++k) {
      double best = squared(s, t), to_s = s, to_t = t;
      for (int u = 0; u < 16; ++u) {
        const double ps = std::clamp(s + step * std::cos(u * M_PI / 8), 0.0, 1.0),
                     pt = std::clamp(t + step * std::sin(u * M_PI / 8), 0.0, 1.0);
        if (squared(ps, pt) < best) best = squared(ps, pt), to_s = ps, to_t = pt;
      }
      if (to_s == s && to_t == t) step /= 2;
      s = to_s;
      t = to_t;
    }
    const double off_rim = std::min({s, 1 - s, t, 1 - t});
    if (off_rim > 1e-4) {
      ++inside;
      CHECK(may_be_inside_both(a, b));
      CHECK(closest_points(a, b).mask_a == 3);
      CHECK(closest_points(a, b).mask_b == 3);
    } else if (off_rim < 1e-8 && i % 3 != 0) {
      ++outside;
      const ClosestPoints c = closest_points(a, b);
      if (!may_be_inside_both(a, b)) CHECK((c.mask_a != 3 || c.mask_b != 3));
    }
  }
  CHECK(inside > 150);
  CHECK(outside > 500);
  CHECK_FALSE(may_be_inside_both({2, {Vec3(0, 0, 0), Vec3(1, 0, 0)}}, {2, {Vec3(0, 1, 0), Vec3(1, 1, 0)}}));
}
