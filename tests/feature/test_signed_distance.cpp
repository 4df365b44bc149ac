#include "bodies.hpp"
#include "catch.hpp"
#include "feature/signed_distance.hpp"
#include "loop/triangle_oracle.hpp"
#include "models/shapes.hpp"
#include "winding_number.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

SignedDistance field(const TriangleMesh& mesh) {
  const auto m = shared(mesh);
  return SignedDistance(std::make_shared<Surface>(m), std::make_shared<PatchTree>(m));
}

}  // namespace

TEST_CASE("the distance is that to all triangles, the sign that of the winding number", "[feature]") {
  std::mt19937 rng(3);
  std::vector<TriangleMesh> meshes{random_convex_body(rng, 14, 0.03),
                                   random_star_body(rng, 16, 0.03),
                                   random_star_body(rng, 16, 0.03),
                                   shapes::block_with_hole({}),
                                   shapes::peg({}),
                                   shapes::torus_knot({})};
  for (const TriangleMesh& mesh : meshes) {
    CAPTURE(mesh.name);
    const SignedDistance f = field(mesh);
    int inside = 0;
    std::uint32_t hint = 0;
    for (int i = 0; i < 400; ++i) {
      Vec3 p = random_vector(rng, 0.04);
      // Half of them near a corner, where the sign is hard.
      if (i % 2 == 0) p = mesh.vertices[rng() % mesh.vertices.size()] + random_vector(rng, 2e-3);
      const SurfacePoint at = f.at(p, hint);
      hint = at.face;
      const double distance = distance_to_surface(mesh, p), winding = winding_number(mesh, p);
      REQUIRE(std::abs(at.distance) == Approx(distance).margin(1e-12));
      REQUIRE((at.point - p).norm() == Approx(distance).margin(1e-12));
      if (distance < 1e-9) continue;
      REQUIRE((at.distance < 0) == (winding > 0.5));
      REQUIRE(at.normal.norm() == Approx(1.0));
      REQUIRE((p - at.distance * at.normal - at.point).norm() < 1e-12);
      inside += at.distance < 0;
    }
    CHECK(inside > 20);
  }
}

TEST_CASE("beside an open sheet is outside, behind it inside", "[feature]") {
  TriangleMesh sheet;
  sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  const SignedDistance f = field(sheet);
  CHECK(f.at({0.5, 0.4, 0.1}, 0).distance == Approx(0.1));
  CHECK(f.at({0.5, 0.4, -0.1}, 0).distance == Approx(-0.1));
  CHECK(f.at({1.5, 0.4, -0.1}, 0).distance == Approx(std::hypot(0.5, 0.1)));
}
