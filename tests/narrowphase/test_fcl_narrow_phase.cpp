#include <set>

#include "bodies.hpp"
#include "catch.hpp"
#include "narrowphase/fcl_narrow_phase.hpp"
#include "winding_number.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

/// Whether the segment p–q crosses the triangle, by signed volumes (general position).
bool crosses(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& t) {
  const auto volume = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return (b - a).dot((c - a).cross(d - a)) > 0;
  };
  if (volume(p, t[0], t[1], t[2]) == volume(q, t[0], t[1], t[2])) return false;
  const bool s = volume(p, q, t[0], t[1]);
  return s == volume(p, q, t[1], t[2]) && s == volume(p, q, t[2], t[0]);
}

bool intersect(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  for (int k = 0; k < 3; ++k)
    if (crosses(a[k], a[(k + 1) % 3], b) || crosses(b[k], b[(k + 1) % 3], a)) return true;
  return false;
}

std::array<Vec3, 3> triangle(const TriangleMesh& m, std::uint32_t f, const Pose& X) {
  const auto& t = m.triangles[f];
  return {X * m.vertices[t[0]], X * m.vertices[t[1]], X * m.vertices[t[2]]};
}

}  // namespace

TEST_CASE("the intersecting pairs are those of brute force, for every part", "[narrowphase]") {
  std::mt19937 rng(41);
  const TriangleMesh held = random_star_body(rng, 16, 0.03);
  const TriangleMesh first = random_star_body(rng, 16, 0.03), second = random_convex_body(rng, 16, 0.04);
  FclNarrowPhase narrow(held, {&first, &second, &first});
  int hits = 0, free = 0;
  for (int round = 0; round < 300; ++round) {
    const auto part = static_cast<std::uint32_t>(rng() % 3);
    const TriangleMesh& other = part == 1 ? second : first;
    const Pose X{rotation(3 * random_direction(rng)), random_vector(rng, 0.05)};
    std::set<std::pair<std::uint32_t, std::uint32_t>> expected, found;
    for (std::uint32_t a = 0; a < held.triangles.size(); ++a)
      for (std::uint32_t b = 0; b < other.triangles.size(); ++b)
        if (intersect(triangle(held, a, X), triangle(other, b, Pose{}))) expected.insert({a, b});
    std::vector<FacePair> pairs;
    const int count = narrow.intersections(part, X, 100000, pairs);
    REQUIRE(count == static_cast<int>(pairs.size()));
    for (const FacePair& p : pairs) {
      REQUIRE(p.part == part);
      found.insert({p.a, p.b});
    }
    REQUIRE(found == expected);
    REQUIRE(narrow.intersects(part, X) == !expected.empty());
    (expected.empty() ? free : hits)++;
    std::vector<FacePair> few;
    if (expected.size() > 3) REQUIRE(narrow.intersections(part, X, 3, few) == 3);
  }
  REQUIRE(hits > 50);
  REQUIRE(free > 50);
}

TEST_CASE("the winding number is 1 inside and 0 outside of a convex body", "[narrowphase]") {
  std::mt19937 rng(42);
  for (int round = 0; round < 20; ++round) {
    const TriangleMesh body = random_convex_body(rng, 16, 0.03);
    for (int i = 0; i < 100; ++i) {
      const Vec3 p = random_vector(rng, 0.05);
      bool inside = true;
      for (std::uint32_t f = 0; f < body.triangles.size(); ++f) {
        const auto t = triangle(body, f, Pose{});
        inside &= (t[1] - t[0]).cross(t[2] - t[0]).dot(p - t[0]) < 0;
      }
      REQUIRE(winding_number(body, p) == Approx(inside ? 1.0 : 0.0).margin(1e-9));
    }
  }
}
