// Distances and intersections of surfaces by a front of patches against brute force over all pairs of triangles and
// against FCL's own hierarchies.
#include <atomic>
#include <cmath>
#include <functional>

#include "bodies.hpp"
#include "catch.hpp"
#include "feature/surface_distance.hpp"
#include "models/shapes.hpp"
#include "narrowphase/fcl_near_triangles.hpp"
#include "narrowphase/fcl_pairs.hpp"
#include "triangle_distance.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

std::shared_ptr<const PatchTree> tree(const std::shared_ptr<const TriangleMesh>& mesh) {
  return std::make_shared<PatchTree>(mesh);
}

/// What was seen at a number of poses.
struct Seen {
  int apart = 0, crossing = 0;
};

/// Asks one front after the other, poses in order, about all of `poses`.
Seen compare(const std::shared_ptr<const TriangleMesh>& a, const std::shared_ptr<const TriangleMesh>& b, int poses,
             const std::function<Pose(int)>& pose) {
  SurfaceDistance surfaces(tree(a), tree(b));
  FclNearTriangles near(tree(a), tree(b));
  FclPairs fcl;
  Seen seen;
  for (int i = 0; i < poses; ++i) {
    const Pose X = pose(i);
    const double expected = brute_distance(*a, X, *b, Pose());
    INFO("pose " << i << ", distance " << expected);
    NearestPoints found;
    REQUIRE(surfaces.within(std::numeric_limits<double>::infinity(), X, found));
    REQUIRE(found.distance == Approx(expected).margin(NearFront::kTolerance));
    if (expected > 0) REQUIRE((found.on_a - found.on_b).norm() == Approx(expected).margin(NearFront::kTolerance));
    // A limit on either side of it.
    if (expected > 1e-9) REQUIRE_FALSE(surfaces.within(0.999 * expected, X, found));
    REQUIRE(surfaces.within(1.001 * expected + 1e-9, X, found));
    REQUIRE(found.distance == Approx(expected).margin(NearFront::kTolerance));
    const bool crosses = fcl.intersect(*a, *b, X);
    REQUIRE(near.intersect(X) == crosses);
    if (std::abs(expected) > 1e-9) REQUIRE_FALSE(crosses);
    ++(crosses ? seen.crossing : seen.apart);
  }
  return seen;
}

}  // namespace

TEST_CASE("distances of bodies at random poses are those of all pairs of triangles", "[feature]") {
  std::mt19937 rng(GENERATE(1, 2, 3));
  const auto a = shared(random_star_body(rng, 30, 0.01)), b = shared(random_convex_body(rng, 24, 0.012));
  const Seen seen = compare(a, b, 60, [&](int) {
    return Pose{rotation(random_vector(rng, 3)), random_vector(rng, 0.02)};
  });
  CHECK(seen.apart > 7);
  CHECK(seen.crossing > 7);
}

TEST_CASE("distances along a path that comes near, touches and leaves", "[feature]") {
  std::mt19937 rng(7);
  const auto a = shared(random_star_body(rng, 30, 0.01)), b = shared(random_star_body(rng, 30, 0.01));
  const Seen seen = compare(a, b, 100, [](int i) {
    const double s = 0.06 * i;
    return Pose{rotation({0.3 * s, 0.2 * std::sin(s), s}),
                {0.016 + 0.006 * std::sin(1.7 * s), 0.001 * std::cos(3 * s), 0}};
  });
  CHECK(seen.apart > 30);
  CHECK(seen.crossing > 8);
}

TEST_CASE("distances in a tight fit, where many triangles are equally near", "[feature]") {
  // A box in a frame of four boxes with 20 um of play, pushed about and turned a little, and through a wall in the end.
  TriangleMesh frame;
  for (const auto& [size, at] : std::initializer_list<std::pair<Vec3, Vec3>>{{{0.01, 0.03, 0.01}, {0.01002, 0, 0}},
                                                                             {{0.01, 0.03, 0.01}, {-0.01002, 0, 0}},
                                                                             {{0.01, 0.01, 0.01}, {0, 0.01002, 0}},
                                                                             {{0.01, 0.01, 0.01}, {0, -0.01002, 0}}}) {
    const TriangleMesh one = shapes::box(size, {2, 2, 2});
    const auto base = static_cast<std::uint32_t>(frame.vertices.size());
    for (const Vec3& v : one.vertices) frame.vertices.emplace_back(v + at);
    for (const auto& t : one.triangles) frame.triangles.push_back({base + t[0], base + t[1], base + t[2]});
  }
  const auto a = shared(shapes::box({0.01, 0.01, 0.012}, {2, 2, 2})), b = shared(frame);
  const Seen seen = compare(a, b, 50, [](int i) {
    const double s = 0.3 * i;
    return Pose{rotation({0, 0, 1e-3 * std::sin(2 * s)}), {2e-6 * s * std::sin(s), 1e-5 * std::cos(1.3 * s), 1e-4 * s}};
  });
  CHECK(seen.apart > 20);
  CHECK(seen.crossing > 1);
}

TEST_CASE("triangles without area have distances too", "[feature]") {
  TriangleMesh needles;
  needles.vertices = {{0, 0, 0}, {0.01, 0, 0}, {0.02, 0, 0}, {0, 0, 0.01}, {0, 0, 0.01}, {0.001, 0.002, 0.01}};
  needles.triangles = {{0, 1, 2}, {3, 4, 5}, {4, 4, 4}};
  const auto a = shared(needles), b = shared(shapes::box({0.01, 0.01, 0.01}, {2, 2, 2}));
  SurfaceDistance surfaces(tree(a), tree(b));
  for (int i = 0; i < 50; ++i) {
    const double height = 0.001 * i;
    NearestPoints found;
    REQUIRE(surfaces.within(1, {Quat::Identity(), {0, 0, 0.005 + 1e-6 + height}}, found));
    CHECK(found.distance == Approx(1e-6 + height).margin(NearFront::kTolerance));
  }
}

TEST_CASE("a question that is broken off has no answer", "[feature]") {
  std::atomic<bool> stop{false};
  const auto a = shared(box({0.01, 0.01, 0.01})), b = shared(box({0.02, 0.02, 0.01}));
  FclNearTriangles near(tree(a), tree(b));
  const Pose X{Quat::Identity(), Vec3(0, 0, 0.009)};
  CHECK(near.intersect(X, &stop));
  stop = true;
  CHECK_FALSE(near.intersect(X, &stop));
}
