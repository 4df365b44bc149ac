#include <random>

#include "broadphase/bounding_spheres.hpp"
#include "catch.hpp"

using namespace tegotae;

TEST_CASE("no part with a vertex within the distance is missed", "[broadphase]") {
  std::mt19937 rng(7);
  std::uniform_real_distribution<double> u(-1, 1);
  const auto random_vector = [&](double s) { return Vec3(s * u(rng), s * u(rng), s * u(rng)); };
  for (int round = 0; round < 50; ++round) {
    BoundingSpheres spheres;
    std::vector<std::vector<Vec3>> world;
    for (int part = 0; part < 40; ++part) {
      TriangleMesh mesh;
      for (int i = 0; i < 12; ++i) mesh.vertices.push_back(random_vector(0.1));
      const Pose X{rotation(random_vector(2)), random_vector(1)};
      spheres.add(bounding_sphere(mesh), X);
      world.emplace_back();
      for (const Vec3& v : mesh.vertices) world.back().push_back(X * v);
    }
    const Vec3 c = random_vector(1);
    const double radius = 0.2, distance = 0.05;
    std::vector<std::uint32_t> near;
    spheres.query(c, radius, distance, near);
    std::size_t missed = 0, far = 0;
    for (std::uint32_t part = 0; part < world.size(); ++part) {
      double closest = 1e9;
      for (const Vec3& v : world[part]) closest = std::min(closest, (v - c).norm());
      const bool found = std::find(near.begin(), near.end(), part) != near.end();
      if (closest <= radius + distance && !found) ++missed;
      // A part of at most 0.35 m across whose vertices are all that far away cannot have its sphere within reach.
      if (closest > radius + distance + 0.35 && found) ++far;
    }
    REQUIRE(missed == 0);
    REQUIRE(far == 0);
    REQUIRE(std::is_sorted(near.begin(), near.end()));
  }
}
