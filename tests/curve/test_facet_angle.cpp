// The quick answer of the search for axes is the slow one's.
#include <cmath>
#include <limits>
#include <random>

#include "catch.hpp"
#include "curve/facet_angle.hpp"
#include "curve/facets.hpp"

using namespace tegotae;

TEST_CASE("a facet is within the angle that it is off, and within no less") {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const auto vec = [&] {
    const double x = normal(random), y = normal(random), z = normal(random);
    return Vec3(x, y, z);
  };
  int near = 0;
  for (int i = 0; i < 20000; ++i) {
    // A facet about a radius, as a chord of a motion about z is, more or less.
    const double wide = std::pow(10, -0.5 * (i % 7));
    TriangleMesh mesh;
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(Vec3(1, 0, 0) + wide * vec().cwiseProduct(Vec3(0.05, 1, 1)));
    mesh.triangles = {{0, 1, 2}};
    const Facets facets(mesh);
    if (facets.all.empty()) continue;
    ScrewMotion motion;
    motion.c = (Vec3(0, 0, 1) + 0.05 * vec()).normalized();
    motion.c_bar = -motion.c.cross((Vec3::Zero() - facets.middle) / facets.size) + 0.1 * normal(random) * motion.c;
    const double off = angle_off(facets.all.front(), motion);
    CHECK(is_within(facets.all.front(), motion, off));
    if (off > 0) CHECK(!is_within(facets.all.front(), motion, std::nextafter(off, 0)));
    for (const double tolerance : {0.02, 0.04, 0.08})
      CHECK(is_within(facets.all.front(), motion, tolerance) == (off <= tolerance));
    near += off < 0.08 ? 1 : 0;
  }
  CHECK(near > 1000);
}
