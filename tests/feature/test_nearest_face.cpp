#include <cmath>
#include <random>

#include "bodies.hpp"
#include "catch.hpp"
#include "feature/nearest_face.hpp"
#include "models/shapes.hpp"
#include "triangle_distance.hpp"

using namespace tegotae;
using namespace tegotae::test;

TEST_CASE("the nearest face of a flat region is that of all of its faces", "[feature]") {
  std::mt19937 rng(7);
  const std::vector<TriangleMesh> meshes{shapes::box({0.03, 0.02, 0.01}, {7, 5, 3}), shapes::block_with_hole({}),
                                         shapes::cylinder(0.02, 0.04, 24, 9), shapes::peg({}),
                                         // Each pair of triangles is a region of its own, and some are of one.
                                         random_star_body(rng, 40, 0.03)};
  for (const TriangleMesh& mesh : meshes) {
    CAPTURE(mesh.name);
    const auto m = shared(mesh);
    const auto surface = std::make_shared<Surface>(m);
    const NearestFace nearest(surface, std::make_shared<PatchTree>(m));
    const std::vector<std::uint32_t>& of_face = surface->regions.of_face;
    for (int i = 0; i < 300; ++i) {
      const auto face = static_cast<std::uint32_t>(rng() % mesh.triangles.size());
      const Vec3 p = mesh.vertices[rng() % mesh.vertices.size()] + random_vector(rng, i % 2 == 0 ? 1e-3 : 2e-2);
      double least = INFINITY;
      for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
        if (f != face && (of_face[face] == kNone || of_face[f] != of_face[face])) continue;
        const auto& t = mesh.triangles[f];
        least = std::min(least, point_triangle(p, {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}));
      }
      const double reach = i % 3 == 0 ? 0.9 * least : 2 * least;
      NearFace near;
      near.squared = reach * reach;
      nearest.find_in_region(p, face, near);
      if (reach < least) {
        REQUIRE(near.face == kNone);
        continue;
      }
      REQUIRE(near.face != kNone);
      REQUIRE((near.face == face || of_face[near.face] == of_face[face]));
      REQUIRE(std::sqrt(near.squared) == Approx(least).margin(1e-12));
      REQUIRE((near.point - p).norm() == Approx(least).margin(1e-12));
    }
  }
}
