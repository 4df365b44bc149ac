#include <cmath>
#include <functional>

#include "bodies.hpp"
#include "catch.hpp"
#include "models/shapes.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/mesh/report.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

const double kPi = std::acos(-1.0);

/// Area of a regular polygon of n corners at radius r.
double polygon(int n, double r) {
  return 0.5 * n * r * r * std::sin(2 * kPi / n);
}

/// Frustum between two similar regular polygons.
double frustum(int n, double r0, double r1, double h) {
  return h / 3 * (polygon(n, r0) + polygon(n, r1) + std::sqrt(polygon(n, r0) * polygon(n, r1)));
}

void require_closed(const TriangleMesh& mesh) {
  const MeshReport r = report(mesh);
  INFO(mesh.name);
  REQUIRE(r.closed);
  REQUIRE(r.components == 1);
  REQUIRE(r.degenerate_faces == 0);
  REQUIRE(r.duplicate_faces == 0);
  REQUIRE(r.vertices == mesh.vertices.size());
}

}  // namespace

TEST_CASE("pegs are closed, inscribed and have the volume of their prism", "[models]") {
  for (int segments : {3, 8, 64, 250}) {
    for (double chamfer : {0.0, 0.0005, 0.003}) {
      shapes::Peg p;
      p.segments = segments;
      p.chamfer = chamfer;
      const TriangleMesh mesh = shapes::peg(p);
      require_closed(mesh);
      const double r = p.diameter / 2;
      const double expected = polygon(segments, r) * (p.length - chamfer) + frustum(segments, r - chamfer, r, chamfer);
      REQUIRE(volume(mesh) == Approx(expected).epsilon(1e-12));
      double largest = 0, lowest = 0;
      for (const Vec3& v : mesh.vertices) {
        largest = std::max(largest, v.head<2>().norm());
        lowest = std::min(lowest, v.z());
      }
      REQUIRE(largest <= r * (1 + 1e-15));
      REQUIRE(lowest == -p.length / 2);
    }
  }
}

TEST_CASE("holes are closed, circumscribed and have the volume of block less prism", "[models]") {
  for (int segments : {8, 64, 256}) {
    for (double chamfer : {0.0, 0.001}) {
      for (bool through : {false, true}) {
        shapes::Block p;
        p.segments = segments;
        p.chamfer = chamfer;
        p.through = through;
        p.size = {0.06, 0.05, 0.05};
        const TriangleMesh mesh = shapes::block_with_hole(p);
        require_closed(mesh);
        const double r = p.hole_diameter / 2, k = 1 / std::cos(kPi / segments);
        const double depth = through ? p.size.z() : p.depth;
        const double hole =
            polygon(segments, r * k) * (depth - chamfer) + frustum(segments, r * k, (r + chamfer) * k, chamfer);
        REQUIRE(volume(mesh) == Approx(p.size.prod() - hole).epsilon(1e-12));
        // The facets' distance from the axis: of every triangle inside, the nearest point of its plane.
        double nearest = 1;
        for (const auto& t : mesh.triangles) {
          const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
          const Vec3 n = (b - a).cross(c - a).normalized();
          if (std::abs(n.z()) < 1e-9) nearest = std::min(nearest, std::abs(n.dot(a)));
        }
        REQUIRE(nearest >= r * (1 - 1e-14));
        REQUIRE(nearest <= r * (1 + 1e-14));
      }
    }
  }
}

TEST_CASE("boxes, cylinders, spheres and knots are closed and face outward", "[models]") {
  const TriangleMesh box = shapes::box({0.1, 0.2, 0.3}, {3, 1, 4});
  require_closed(box);
  REQUIRE(box.triangles.size() == 2 * 2 * (3 * 1 + 1 * 4 + 4 * 3));
  REQUIRE(volume(box) == Approx(0.006).epsilon(1e-12));

  const TriangleMesh rod = shapes::cylinder(0.01, 0.5, 12, 5);
  require_closed(rod);
  REQUIRE(volume(rod) == Approx(polygon(12, 0.005) * 0.5).epsilon(1e-12));

  const TriangleMesh ball = shapes::sphere(0.1, 200, 100);
  require_closed(ball);
  for (const Vec3& v : ball.vertices) REQUIRE(v.norm() == Approx(0.05).epsilon(1e-14));
  const double full = kPi / 6 * 1e-3;
  REQUIRE(volume(ball) < full);
  REQUIRE(volume(ball) > full * (1 - 1e-3));

  shapes::Knot k;
  k.along = 2000;
  k.around = 64;
  const TriangleMesh knot = shapes::torus_knot(k);
  require_closed(knot);
  REQUIRE(knot.triangles.size() == 2u * 2000u * 64u);
  // Pappus: the section's area times the length of the center line.
  double length = 0;
  const int steps = 100000;
  for (int i = 0; i < steps; ++i) {
    const double b = 2 * kPi * k.q * (i + 0.5) / steps;
    length += 2 * kPi / steps * std::hypot(k.p * (k.radius + k.tube_radius * std::cos(b)), k.q * k.tube_radius);
  }
  REQUIRE(volume(knot) == Approx(polygon(64, k.thickness / 2) * length).epsilon(1e-3));
}

TEST_CASE("peg and hole keep the radial clearance of their diameters when turned against each other", "[models]") {
  shapes::Peg p;
  p.diameter = 0.999 * 0.020;
  p.segments = 256;
  shapes::Block b;
  b.segments = 64;
  const TriangleMesh peg = shapes::peg(p), hole = shapes::block_with_hole(b);
  for (int turn = 0; turn < 20; ++turn) {
    const Eigen::AngleAxisd R(0.0171 * turn, Vec3::UnitZ());
    double gap = 1;
    for (const auto& t : hole.triangles) {
      const Vec3 &a = hole.vertices[t[0]], &u = hole.vertices[t[1]], &v = hole.vertices[t[2]];
      const Vec3 n = (u - a).cross(v - a).normalized();
      if (std::abs(n.z()) > 1e-9 || n.head<2>().dot(a.head<2>()) > 0) continue;  // only walls that face the axis
      for (const Vec3& q : peg.vertices) gap = std::min(gap, n.dot(R * q - a));
    }
    REQUIRE(gap >= 10e-6 - 1e-15);
  }
}

TEST_CASE("impossible shapes are refused", "[models]") {
  shapes::Peg p;
  p.chamfer = 0.02;
  REQUIRE_THROWS_AS(shapes::peg(p), Error);
  shapes::Block b;
  b.segments = 60;
  REQUIRE_THROWS_AS(shapes::block_with_hole(b), Error);
  b.segments = 64;
  b.hole_diameter = 0.059;
  REQUIRE_THROWS_AS(shapes::block_with_hole(b), Error);
  b.hole_diameter = 0.02;
  b.depth = 0.05;
  REQUIRE_THROWS_AS(shapes::block_with_hole(b), Error);
  REQUIRE_THROWS_AS(shapes::box({1, 0, 1}), Error);
  REQUIRE_THROWS_AS(shapes::sphere(1, 2, 2), Error);
  shapes::Knot k;
  k.p = 2;
  k.q = 4;
  REQUIRE_THROWS_AS(shapes::torus_knot(k), Error);
}
