#include "mesh/flat_regions.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "bodies.hpp"
#include "catch.hpp"
#include "models/shapes.hpp"
#include "tegotae/core/constants.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

std::set<std::uint32_t> corners_of(const FlatRegions& r, std::uint32_t region) {
  return {r.corners.begin() + r.corner_begin[region], r.corners.begin() + r.corner_begin[region + 1]};
}

}  // namespace

TEST_CASE("each side of a divided box is one flat region with four corners", "[regions]") {
  const Vec3 size(0.04, 0.03, 0.02);
  const TriangleMesh mesh = shapes::box(size, {8, 6, 4});
  const FlatRegions r = find_flat_regions(mesh, build_topology(mesh));
  REQUIRE(r.corner_begin.size() == 6 + 1);
  std::array<std::set<std::uint32_t>, 6> normals;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    REQUIRE(r.of_face[f] < 6);
    // All three corners of the face have the coordinate of its side.
    const auto& t = mesh.triangles[f];
    for (std::uint32_t k = 0; k < 3; ++k)
      for (const double side : {-1.0, 1.0})
        if (std::all_of(t.begin(), t.end(),
                        [&](std::uint32_t v) { return std::abs(mesh.vertices[v][k] - 0.5 * side * size[k]) < 1e-12; }))
          normals[r.of_face[f]].insert(2 * k + (side > 0 ? 1 : 0));
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    CHECK(normals[i].size() == 1);
    CHECK(corners_of(r, i).size() == 4);
    for (const std::uint32_t v : corners_of(r, i))
      for (int k = 0; k < 3; ++k) CHECK(std::abs(mesh.vertices[v][k]) == Approx(0.5 * size[k]));
  }
}

TEST_CASE("a fan of any number of needles is one region that keeps the extremes of its rim, in order", "[regions]") {
  const auto n = static_cast<std::uint32_t>(GENERATE(3, 9, 16, 17, 90, 1440));
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double a = 2 * M_PI * (i + 0.3) / n;
    mesh.vertices.push_back(0.03 * Vec3(std::cos(a), std::sin(a), 0));
  }
  mesh.vertices.push_back(Vec3::Zero());
  for (std::uint32_t i = 0; i < n; ++i) mesh.triangles.push_back({n, i, (i + 1) % n});
  const FlatRegions r = find_flat_regions(mesh, build_topology(mesh));
  REQUIRE(r.corner_begin.size() == 2);
  CHECK(std::all_of(r.of_face.begin(), r.of_face.end(), [](std::uint32_t f) { return f == 0; }));
  REQUIRE(r.corners.size() == std::min<std::size_t>(n, kMaxRegionCorners));
  CHECK(corners_of(r, 0).size() == r.corners.size());
  CHECK(corners_of(r, 0).count(n) == 0);
  // Once around, in one sense: the turns between one and the next add up to a whole one.
  double turned = 0;
  for (std::size_t i = 0; i < r.corners.size(); ++i) {
    const Vec3 &a = mesh.vertices[r.corners[i]], &b = mesh.vertices[r.corners[(i + 1) % r.corners.size()]];
    turned += std::atan2(a.cross(b).z(), a.dot(b));
  }
  CHECK(std::abs(turned) == Approx(2 * M_PI));
}

TEST_CASE("curved and noisy surfaces have no flat regions, and a fine cylinder is not one plane", "[regions]") {
  const TriangleMesh ball = shapes::sphere(0.02, 48, 24);
  const FlatRegions none = find_flat_regions(ball, build_topology(ball));
  // Only the two triangles of a field between two circles of latitude may lie in a plane.
  std::vector<int> count(none.corner_begin.size(), 0);
  for (const std::uint32_t region : none.of_face)
    if (region != kNone) ++count[region];
  CHECK(*std::max_element(count.begin(), count.end()) <= 2);

  // 100 000 sides: neighbors differ by less than kFlatAngle.
  const TriangleMesh fine = shapes::cylinder(0.02, 0.01, 100000);
  const FlatRegions r = find_flat_regions(fine, build_topology(fine));
  CHECK(static_cast<double>(r.corner_begin.size()) > M_PI / kFlatAngle);
}

TEST_CASE("regions end at rims that do not join, and collapsed faces are in none", "[regions]") {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0.5, 0}, {2, 0, 0}, {2, 1, 0}};
  // A square of two faces, and one that meets it with a corner in the middle of its side.
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 5, 4}, {4, 5, 6}, {4, 6, 2}, {1, 1, 5}};
  const FlatRegions r = find_flat_regions(mesh, build_topology(mesh));
  REQUIRE(r.corner_begin.size() == 3);
  CHECK(r.of_face == std::vector<std::uint32_t>{0, 0, 1, 1, 1, kNone});
  CHECK(corners_of(r, 0) == std::set<std::uint32_t>{0, 1, 2, 3});
  CHECK(corners_of(r, 1) == std::set<std::uint32_t>{1, 2, 5, 6});
}
