// The clash list against closed forms and against brute force over all triangles.
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "catch.hpp"
#include "feature/simplex_distance.hpp"
#include "models/shapes.hpp"
#include "tegotae/loop/clash.hpp"
#include "winding_number.hpp"

using namespace tegotae;

namespace {

Part part(const std::string& name, TriangleMesh mesh, const Vec3& p = Vec3::Zero(), const Quat& q = Quat::Identity()) {
  Part out;
  out.name = name;
  out.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
  out.pose = {q, p};
  return out;
}

std::vector<Clash> clashes(std::vector<Part> parts, double within = 0) {
  Scene scene;
  scene.parts = std::move(parts);
  ClashOptions options;
  options.within = within;
  return find_clashes(scene, options);
}

Simplex triangle(const Part& p, std::size_t f) {
  const auto& t = p.mesh->triangles[f];
  return {3, {p.pose * p.mesh->vertices[t[0]], p.pose * p.mesh->vertices[t[1]], p.pose * p.mesh->vertices[t[2]]}};
}

double surface_distance(const Part& p, const Vec3& point_W) {
  double least = 1e9;
  for (std::size_t f = 0; f < p.mesh->triangles.size(); ++f)
    least = std::min(least, closest_points({1, {point_W}}, triangle(p, f)).squared_distance);
  return std::sqrt(least);
}

bool is_inside(const Part& p, const Vec3& point_W) {
  return test::winding_number(*p.mesh, p.pose.inverse() * point_W) > 0.5;
}

/// Depth of the deepest of n² points on each triangle of `a` in `b`.
double sampled_depth(const Part& a, const Part& b, int n) {
  double most = 0;
  for (std::size_t f = 0; f < a.mesh->triangles.size(); ++f) {
    const Simplex t = triangle(a, f);
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) {
        const Vec3 p = t.p[0] + (t.p[1] - t.p[0]) * i / n + (t.p[2] - t.p[0]) * j / n;
        if (is_inside(b, p)) most = std::max(most, surface_distance(b, p));
      }
    }
  }
  return most;
}

double least_distance(const Part& a, const Part& b) {
  double least = 1e9;
  for (std::size_t i = 0; i < a.mesh->triangles.size(); ++i)
    for (std::size_t j = 0; j < b.mesh->triangles.size(); ++j)
      least = std::min(least, closest_points(triangle(a, i), triangle(b, j)).squared_distance);
  return std::sqrt(least);
}

/// Whether an edge of `a` passes through a triangle of `b`.
bool edges_cross(const Part& a, const Part& b) {
  for (std::size_t i = 0; i < a.mesh->triangles.size(); ++i) {
    const Simplex s = triangle(a, i);
    for (std::size_t j = 0; j < b.mesh->triangles.size(); ++j) {
      const Simplex t = triangle(b, j);
      for (int k = 0; k < 3; ++k) {
        const Vec3 &p = s.p[k], &q = s.p[(k + 1) % 3];
        const auto volume = [](const Vec3& a1, const Vec3& b1, const Vec3& c1, const Vec3& d1) {
          return (b1 - a1).cross(c1 - a1).dot(d1 - a1);
        };
        if (volume(t.p[0], t.p[1], t.p[2], p) * volume(t.p[0], t.p[1], t.p[2], q) >= 0) continue;
        const double u = volume(p, q, t.p[0], t.p[1]), v = volume(p, q, t.p[1], t.p[2]),
                     w = volume(p, q, t.p[2], t.p[0]);
        if ((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0)) return true;
      }
    }
  }
  return false;
}

}  // namespace

TEST_CASE("clashes of boxes are what they are by construction", "[clash]") {
  const TriangleMesh cube = shapes::box({0.02, 0.02, 0.02});
  const auto one = [&](const Vec3& at, double within = 0) {
    const auto found = clashes({part("a", cube), part("b", cube, at)}, within);
    REQUIRE(found.size() <= 1);
    return found.empty() ? Clash{9, 9} : found[0];
  };
  SECTION("far apart") {
    CHECK(one({0.03, 0, 0}).a == 9);
    CHECK(one({0.03, 0, 0}, 0.0099).a == 9);
  }
  SECTION("near") {
    const Clash c = one({0.03, 0.003, 0}, 0.0101);
    CHECK(c.kind == ClashKind::near);
    CHECK(c.gap == Approx(0.01));
    CHECK(c.depth.value() == 0);
    CHECK(c.place_W.x() == Approx(0.015));
  }
  SECTION("a seat at exactly zero gap") {
    const Clash c = one({0.02, 0.001, 0.002});
    CHECK(c.kind == ClashKind::touch);
    CHECK(c.gap == 0);
    CHECK(c.depth.value() < 1e-12);
  }
  SECTION("a gap and an overlap within the tolerance") {
    CHECK(one({0.020009, 0, 0}).kind == ClashKind::touch);
    CHECK(one({0.020009, 0, 0}).gap == Approx(9e-6));
    CHECK(one({0.019991, 0.001, 0.002}).kind == ClashKind::touch);
    CHECK(one({0.019991, 0.001, 0.002}).depth.value() == Approx(9e-6));
    CHECK(one({0.020011, 0, 0}).a == 9);
    CHECK(one({0.020011, 0, 0}, 12e-6).kind == ClashKind::near);
  }
  SECTION("overlap") {
    const Clash c = one({0.019, 0.005, 0.006});
    CHECK(c.kind == ClashKind::overlap);
    CHECK(c.depth.value() == Approx(0.001));
    CHECK(c.gap == 0);
    CHECK(std::abs(std::abs(c.place_W.x() - 0.0095) - 0.0005) < 1e-9);
  }
}

TEST_CASE("bars that cross have no vertex in each other and still a depth", "[clash]") {
  // Square bars 10 mm wide, 4 mm into each other at right angles: the edges of one cross the other 4 mm deep.
  const auto found =
      clashes({part("a", shapes::box({0.1, 0.01, 0.01})), part("b", shapes::box({0.01, 0.1, 0.01}), {0, 0, 0.006})});
  REQUIRE(found.size() == 1);
  CHECK(found[0].kind == ClashKind::overlap);
  CHECK(found[0].depth.value() == Approx(0.004));
}

TEST_CASE("a press fit is as deep as its interference", "[clash]") {
  // The same angles, so that facets are parallel: 20 um of interference on the radius at the corners.
  const int n = 64;
  shapes::Block block;
  block.through = true;
  block.segments = n;
  block.chamfer = 0;
  const double apothem = 0.01;  // the hole is circumscribed
  const TriangleMesh shaft = shapes::cylinder(2 * (apothem / std::cos(M_PI / n) + 20e-6), 0.1, n);
  const auto found = clashes({part("block", shapes::block_with_hole(block)), part("shaft", shaft)});
  REQUIRE(found.size() == 1);
  CHECK(found[0].kind == ClashKind::overlap);
  CHECK(found[0].depth.value() > 19e-6);
  CHECK(found[0].depth.value() < 21e-6);
}

TEST_CASE("a part inside another overlaps it, in a cavity it does not", "[clash]") {
  const TriangleMesh large = shapes::box({0.1, 0.1, 0.1}), small = shapes::box({0.02, 0.02, 0.02});
  auto found = clashes({part("large", large), part("small", small, {0.02, 0, 0})});
  REQUIRE(found.size() == 1);
  CHECK(found[0].kind == ClashKind::overlap);
  CHECK(found[0].depth.value() == Approx(0.04));  // its corners nearest to the middle
  TriangleMesh hollow = large;
  const TriangleMesh cavity = shapes::box({0.06, 0.06, 0.06});
  for (const Vec3& p : cavity.vertices) hollow.vertices.push_back(p);
  for (const auto& t : cavity.triangles) hollow.triangles.push_back({t[0] + 8, t[2] + 8, t[1] + 8});
  CHECK(clashes({part("hollow", hollow), part("small", small)}).empty());
  found = clashes({part("hollow", hollow), part("small", small)}, 0.021);
  REQUIRE(found.size() == 1);
  CHECK(found[0].gap == Approx(0.02));
}

TEST_CASE("open surfaces that cross have no depth", "[clash]") {
  TriangleMesh sheet;
  sheet.vertices = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  sheet.triangles = {{0, 1, 2}};
  const Quat upright(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()));
  const auto found = clashes({part("a", sheet), part("b", sheet, Vec3::Zero(), upright)});
  REQUIRE(found.size() == 1);
  CHECK(found[0].kind == ClashKind::overlap);
  CHECK(!found[0].depth);
}

TEST_CASE("the list agrees with brute force", "[clash]") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-0.045, 0.045);
  std::normal_distribution<double> normal;
  shapes::Knot knot;
  knot.along = 24;
  knot.around = 5;
  const std::shared_ptr<const TriangleMesh> meshes[] = {
      std::make_shared<const TriangleMesh>(shapes::box({0.02, 0.03, 0.04})),
      std::make_shared<const TriangleMesh>(shapes::cylinder(0.02, 0.05, 9)),
      std::make_shared<const TriangleMesh>(shapes::sphere(0.03, 8, 6)),
      std::make_shared<const TriangleMesh>(shapes::torus_knot(knot))};
  const double within = 0.004;
  int kinds[3] = {0, 0, 0}, absent = 0;
  for (int round = 0; round < 12; ++round) {
    Scene scene;
    for (int i = 0; i < 8; ++i) {
      Part p;
      p.mesh = meshes[i % 7 == 6 ? 3 : i % 3];
      p.pose.p = {place(random), place(random), place(random)};
      p.pose.q = Quat(normal(random), normal(random), normal(random), normal(random)).normalized();
      scene.parts.push_back(p);
    }
    ClashOptions options;
    options.within = within;
    const auto found = find_clashes(scene, options);
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
      for (std::size_t j = i + 1; j < scene.parts.size(); ++j) {
        const Part &a = scene.parts[i], &b = scene.parts[j];
        const auto c = std::find_if(found.begin(), found.end(), [&](const Clash& x) { return x.a == i && x.b == j; });
        const bool crossing = edges_cross(a, b) || edges_cross(b, a);
        const bool overlap =
            crossing || is_inside(a, b.pose * b.mesh->vertices[0]) || is_inside(b, a.pose * a.mesh->vertices[0]);
        INFO(round << ": " << i << " " << j);
        if (overlap) {
          REQUIRE(c != found.end());
          REQUIRE(c->depth);
          CHECK(c->gap == 0);
          const double corners = std::max(sampled_depth(a, b, 1), sampled_depth(b, a, 1));
          CHECK(*c->depth >= corners - 1e-12);
          // Of points on a grid none can be deeper than the true depth, which the list may fall short of by what lies
          // between corners and edges; nothing in the list is deeper than where it says it is.
          CHECK(*c->depth <= std::max(sampled_depth(a, b, 12), sampled_depth(b, a, 12)) + 0.004);
          CHECK(std::max(is_inside(a, c->place_W) ? surface_distance(a, c->place_W) : 0,
                         is_inside(b, c->place_W) ? surface_distance(b, c->place_W) : 0) >= *c->depth - 1e-9);
          ++kinds[static_cast<int>(c->kind)];
        } else {
          const double gap = least_distance(a, b);
          if (gap > within) {
            CHECK(c == found.end());
            ++absent;
            continue;
          }
          REQUIRE(c != found.end());
          CHECK(c->gap == Approx(gap).epsilon(1e-6));
          CHECK(c->depth == 0);
          CHECK(surface_distance(a, c->place_W) == Approx(gap / 2).epsilon(1e-6));
          ++kinds[static_cast<int>(c->kind)];
        }
      }
    }
  }
  CHECK(kinds[static_cast<int>(ClashKind::overlap)] > 20);
  CHECK(kinds[static_cast<int>(ClashKind::near)] > 10);
  CHECK(absent > 50);
}

TEST_CASE("two thousand parts are sorted out by their boxes", "[clash]") {
  // A grid of cubes 20 mm apart by 5 um less than their size in x, and by more in y and z.
  Scene scene;
  const auto cube = std::make_shared<const TriangleMesh>(shapes::box({0.02, 0.02, 0.02}));
  for (int i = 0; i < 2000; ++i) {
    Part p;
    p.mesh = cube;
    p.pose.p = {0.019995 * (i % 20), 0.03 * (i / 20 % 10), 0.03 * (i / 200)};
    scene.parts.push_back(p);
  }
  std::size_t pairs = 0;
  ClashOptions options;
  options.progress = [&](std::size_t, std::size_t total) { pairs = total; };
  const auto found = find_clashes(scene, options);
  CHECK(pairs == 1900);  // of two million
  CHECK(found.size() == 1900);
  CHECK(std::all_of(found.begin(), found.end(), [](const Clash& c) { return c.kind == ClashKind::touch; }));
}
