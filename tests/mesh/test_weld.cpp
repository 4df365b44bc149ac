#include <cmath>
#include <random>

#include "catch.hpp"
#include "models/shapes.hpp"
#include "tegotae/import/load.hpp"
#include "tegotae/mesh/report.hpp"

using namespace tegotae;

namespace {

TriangleMesh soup_of(const TriangleMesh& mesh) {
  TriangleMesh out;
  for (const auto& t : mesh.triangles) {
    const auto base = static_cast<std::uint32_t>(out.vertices.size());
    for (const std::uint32_t v : t) out.vertices.push_back(mesh.vertices[v]);
    out.triangles.push_back({base, base + 1, base + 2});
  }
  return out;
}

}  // namespace

TEST_CASE("a soup welds back into its mesh, jitter of a rounding step included", "[weld]") {
  std::mt19937 rng(7);
  const TriangleMesh mesh = shapes::block_with_hole({});
  const double step = std::ldexp(0.05, -23);  // largest coordinate of the block
  std::uniform_real_distribution<double> u(-0.25 * step, 0.25 * step);
  for (const bool jitter : {false, true}) {
    TriangleMesh soup = soup_of(mesh);
    if (jitter) {
      for (Vec3& p : soup.vertices) p += Vec3(u(rng), u(rng), u(rng));
    }
    const TriangleMesh welded = weld(soup);
    REQUIRE(welded.vertices.size() == mesh.vertices.size());
    REQUIRE(welded.triangles.size() == mesh.triangles.size());
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
      for (int k = 0; k < 3; ++k) {
        const Vec3 d = welded.vertices[welded.triangles[f][k]] - mesh.vertices[mesh.triangles[f][k]];
        REQUIRE(d.norm() <= (jitter ? 2 * step : 0));
      }
    }
    REQUIRE(report(welded).closed);
  }
}

TEST_CASE("a gap of 5 um in a part of 25 mm stays open", "[weld]") {
  const TriangleMesh a = shapes::box({0.025, 0.025, 0.01});
  TriangleMesh two = a;
  for (const Vec3& p : a.vertices) two.vertices.push_back(p + Vec3(0, 0, 0.01 + 5e-6));
  for (const auto& t : a.triangles) two.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  REQUIRE(weld(two).vertices.size() == 16);
  REQUIRE(report(weld(two)).components == 2);
}

TEST_CASE("weld drops unused vertices, joins 0 with -0, keeps faces and their order", "[weld]") {
  TriangleMesh mesh;
  mesh.vertices = {{9, 9, 9}, {0.0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0, 0, -0.0}, {1, 1, 0}};
  mesh.triangles = {{1, 2, 3}, {4, 3, 2}, {1, 4, 5}};
  const TriangleMesh welded = weld(mesh);
  REQUIRE(welded.vertices.size() == 4);
  REQUIRE(welded.triangles.size() == 3);
  REQUIRE(welded.triangles[0] == std::array<std::uint32_t, 3>{0, 1, 2});
  REQUIRE(welded.triangles[1] == std::array<std::uint32_t, 3>{0, 2, 1});
  REQUIRE(welded.triangles[2] == std::array<std::uint32_t, 3>{0, 0, 3});
}

TEST_CASE("bit-equal vertices weld whatever lies near them", "[weld]") {
  // A dense cloud, tens of points within a tolerance of each other, every point twice.
  std::mt19937 rng(8);
  const double step = std::ldexp(1.0, -23);
  std::uniform_real_distribution<double> u(0, 20 * step);
  TriangleMesh mesh;
  mesh.vertices.push_back({1, 1, 1});  // sets the mesh's size
  for (int i = 0; i < 3000; ++i) mesh.vertices.push_back(Vec3(u(rng), u(rng), u(rng)));
  for (int i = 3000; i > 0; --i) mesh.vertices.push_back(Vec3(mesh.vertices[i]));
  for (std::uint32_t i = 1; i <= 3000; ++i) mesh.triangles.push_back({0, i, 6001 - i});
  const TriangleMesh welded = weld(mesh);
  for (const auto& t : welded.triangles) REQUIRE(t[1] == t[2]);
  // Nothing moved by more than the tolerance, and what is left is farther apart than it.
  for (std::uint32_t i = 1; i <= 3000; ++i) {
    REQUIRE((welded.vertices[welded.triangles[i - 1][1]] - mesh.vertices[i]).norm() <= step);
  }
  for (std::size_t i = 0; i < welded.vertices.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) REQUIRE((welded.vertices[i] - welded.vertices[j]).norm() > step);
  }
}
