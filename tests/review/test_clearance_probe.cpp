// Clearances against brute force over all pairs of triangles, and against closed forms.
#include <algorithm>
#include <cmath>

#include "bodies.hpp"
#include "catch.hpp"
#include "models/helical.hpp"
#include "models/shapes.hpp"
#include "review/surface_clearance.hpp"
#include "shared/clearance_probe.hpp"
#include "triangle_distance.hpp"

using namespace tegotae;
using namespace tegotae::review;
using namespace tegotae::test;

namespace {

RecordFrame at(double t, const Pose& X) {
  RecordFrame row;
  row.t = t;
  row.x = row.y = X;
  return row;
}

}  // namespace

TEST_CASE("clearances along a path are those of all pairs of triangles") {
  std::mt19937 rng(11);
  Scene scene;
  scene.parts.push_back({"left", shared(random_star_body(rng, 60, 0.01)), {Quat::Identity(), {-0.025, 0, 0}}, false});
  scene.parts.push_back({"held", shared(random_convex_body(rng, 30, 0.008)), Pose{}, true});
  scene.parts.push_back(
      {"right", shared(random_star_body(rng, 60, 0.01)), {rotation({1, 2, 0.5}), {0.025, 0, 0.003}}, false});
  ClearanceProbe probe(scene);
  const double reach = 0.02;
  std::vector<Clearance> found;
  int within = 0, second = 0, intersecting = 0;
  for (int i = 0; i <= 60; ++i) {
    // From the left part to the right one, turning; it runs into the right one at the end.
    const Pose X{rotation({0, 0.02 * i, 0.05 * i}), {-0.008 + 0.0004 * i, 0.001 * std::sin(0.3 * i), 0}};
    probe.at(X, reach, found);
    const double left = brute_distance(*scene.parts[1].mesh, X, *scene.parts[0].mesh, scene.parts[0].pose);
    const double right = brute_distance(*scene.parts[1].mesh, X, *scene.parts[2].mesh, scene.parts[2].pose);
    INFO("pose " << i << ", left " << left << ", right " << right);
    REQUIRE(!found.empty());
    CHECK(found.front().part == (left <= right ? 0u : 2u));
    CHECK(found.front().distance == Approx(std::min(left, right)).margin(1e-12));
    const bool both = std::max(left, right) < reach;
    REQUIRE(found.size() == (both ? 2u : 1u));
    if (both) CHECK(found[1].distance == Approx(std::max(left, right)).margin(1e-12));
    for (const Clearance& c : found)
      if (c.distance > 0) CHECK((c.on_held_W - c.on_other_W).norm() == Approx(c.distance).epsilon(1e-9));
    within += std::min(left, right) < reach;
    second += both;
    intersecting += std::min(left, right) == 0;
  }
  CHECK(within > 20);
  CHECK(second > 0);
  CHECK(intersecting > 0);
  CHECK(intersecting < 40);
}

TEST_CASE("clearances of finely meshed parts: FCL takes small triangles for points unless lengths are large numbers") {
  // Edges of 0.05 to 0.1 mm: the fourth power of that, in m, is under its threshold.
  Scene scene;
  scene.parts.push_back(
      {"plate", shared(shapes::box({2e-3, 2e-3, 1e-3}, {20, 20, 10})), {Quat::Identity(), {0, 0, -5e-4}}});
  scene.parts.push_back({"held", shared(shapes::box({1e-3, 1e-3, 1e-3}, {20, 20, 20})), Pose{}, true});
  ClearanceProbe probe(scene);
  std::vector<Clearance> found;
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 200; ++i) {
    const double gap = std::pow(10, -6 + 3 * unit(rng));
    probe.at({rotation(Vec3(0, 0, 6 * unit(rng))), {4e-4 * unit(rng), 4e-4 * unit(rng), 5e-4 + gap}}, 0, found);
    REQUIRE(found.size() == 1);
    REQUIRE(found[0].distance == Approx(gap).epsilon(1e-9));
  }
}

TEST_CASE("a box over a floor: every point's least clearance is the height of its lowest place") {
  Scene scene;
  scene.parts.push_back({"floor", shared(box({0.2, 0.2, 0.02})), {Quat::Identity(), {0, 0, -0.01}}, false});
  scene.parts.push_back({"held", shared(box({0.02, 0.02, 0.04})), Pose{}, true});
  std::vector<RecordFrame> rows;
  for (int i = 0; i <= 200; ++i) {
    const double s = i / 200.0;
    rows.push_back(
        at(1e-3 * i, {rotation({0.4 * std::sin(5 * s), 0.2 * s, s}), {0.02 * s, 0, 0.06 - 0.03 * std::sin(3 * s)}}));
  }
  const double reach = 0.03;
  const std::vector<std::size_t> all = looked_at(rows.size(), 1000);
  REQUIRE(all.size() == rows.size());
  ColoredSurface surface = sampled_surface(scene.parts[1].mesh, 4000);
  REQUIRE(surface.indices.size() / 3 > 1000);
  REQUIRE(surface.indices.size() / 3 <= 4000);
  add_clearance(scene, rows, all, reach, {}, surface);
  int far = 0;
  for (std::size_t i = 0; i < surface.clearance.size(); ++i) {
    const Vec3 p(surface.positions[3 * i], surface.positions[3 * i + 1], surface.positions[3 * i + 2]);
    // On the box: one coordinate is that of a face.
    const Vec3 q = p.cwiseAbs().cwiseQuotient(Vec3(0.01, 0.01, 0.02));
    REQUIRE(std::abs(q.maxCoeff() - 1) < 1e-6);
    double least = reach;
    for (const RecordFrame& row : rows) least = std::min(least, (row.x * p).z());
    CHECK(surface.clearance[i] == Approx(least).margin(1e-8));
    far += surface.clearance[i] == static_cast<float>(reach);
  }
  CHECK(far > 0);
}

namespace {

/// The clearance of every point as it is defined: all points, poses and triangles.
std::vector<double> brute_clearances(const Scene& scene, const std::vector<RecordFrame>& rows, double reach,
                                     const ColoredSurface& surface) {
  std::vector<Triangle> others;
  for (const Part& part : scene.parts)
    if (!part.held)
      for (const Triangle& t : triangles(*part.mesh, part.pose)) others.push_back(t);
  std::vector<double> out;
  for (std::size_t i = 0; i < surface.positions.size(); i += 3) {
    const Vec3 p(surface.positions[i], surface.positions[i + 1], surface.positions[i + 2]);
    double least = reach;
    for (const RecordFrame& row : rows)
      for (const Triangle& t : others) least = std::min(least, point_triangle(row.x * p, t));
    out.push_back(least);
  }
  return out;
}

/// Asks about all rows and compares; returns how many points are farther than the reach.
int compare(const Scene& scene, const std::vector<RecordFrame>& rows, double reach, std::size_t most) {
  const auto held = std::find_if(scene.parts.begin(), scene.parts.end(), [](const Part& p) { return p.held; });
  ColoredSurface surface = sampled_surface(held->mesh, most);
  add_clearance(scene, rows, looked_at(rows.size(), rows.size()), reach, {}, surface);
  const std::vector<double> expected = brute_clearances(scene, rows, reach, surface);
  int far = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    INFO("point " << i);
    // Of single precision, as colors are.
    REQUIRE(surface.clearance[i] == Approx(expected[i]).epsilon(1e-6).margin(1e-12));
    far += expected[i] == reach;
  }
  return far;
}

}  // namespace

TEST_CASE("colors of a nut that is turned with play are those of all points, poses and triangles") {
  shapes::WavyThread thread;
  thread.segments = 14;
  thread.rings = 6;
  shapes::WavyThread wider = thread;
  wider.radius += 1.5e-4;
  wider.low = -0.004;
  Scene scene;
  scene.parts.push_back({"screw", shared(shapes::screw(thread)), Pose{}, false});
  scene.parts.push_back({"held", shared(shapes::nut(wider, 0.012)), Pose{}, true});
  std::vector<RecordFrame> rows;
  const int count = GENERATE(1, 2, 9, 70);  // below, at and above a run of places
  for (int i = 0; i < count; ++i) {
    // Steps of 1 mm at the thread: more than the gap. The nut rests now and then.
    const double angle = 0.12 * (i / 3 * 3), play = 1e-4;
    rows.push_back(
        at(1e-3 * i, {rotation({0, 0, angle}),
                      {play * std::cos(2 * angle), play * std::sin(3 * angle), thread.pitch * angle / (2 * M_PI)}}));
  }
  const int far = compare(scene, rows, 1e-3, 700);
  CHECK(far > 0);  // its outside
}

TEST_CASE("colors between several parts are those of all points, poses and triangles") {
  std::mt19937 rng(GENERATE(5, 6));
  Scene scene;
  const auto left = shared(random_star_body(rng, 40, 0.01));
  scene.parts.push_back({"left", left, {Quat::Identity(), {-0.025, 0, 0}}, false});
  scene.parts.push_back({"held", shared(random_convex_body(rng, 30, 0.008)), Pose{}, true});
  scene.parts.push_back({"right", left, {rotation({1, 2, 0.5}), {0.025, 0, 0.003}}, false});  // the same mesh
  scene.parts.push_back({"away", left, {Quat::Identity(), {0, 0, 0.2}}, false});
  std::vector<RecordFrame> rows;
  for (int i = 0; i <= 100; ++i)
    // To the left part, then in a jump near the right one, which it cuts.
    rows.push_back(at(1e-3 * i, {rotation({0.01 * i, 0, 0.05 * i}), {i < 50 ? -5e-3 - 6e-5 * i : 0.012, 5e-5 * i, 0}}));
  const int far = compare(scene, rows, 5e-3, 300);
  CHECK(far > 0);
}

TEST_CASE("a surface of many triangles is sampled on itself") {
  // A cylinder of radius 10 mm with 4000 facets.
  TriangleMesh tube;
  const int n = 4000;
  for (int i = 0; i < n; ++i)
    for (const double z : {0.0, 0.03})
      tube.vertices.emplace_back(0.01 * std::cos(2 * M_PI * i / n), 0.01 * std::sin(2 * M_PI * i / n), z);
  for (int i = 0; i < n; ++i) {
    const auto a = static_cast<std::uint32_t>(2 * i), b = static_cast<std::uint32_t>(2 * ((i + 1) % n));
    tube.triangles.push_back({a, b, a + 1});
    tube.triangles.push_back({b, b + 1, a + 1});
  }
  const ColoredSurface surface = sampled_surface(shared(tube), 2000);
  CHECK(surface.indices.size() / 3 <= 2000);
  for (std::size_t i = 0; i < surface.positions.size(); i += 3)
    CHECK(std::abs(std::hypot(surface.positions[i], surface.positions[i + 1]) - 0.01) < 2e-8);
}
