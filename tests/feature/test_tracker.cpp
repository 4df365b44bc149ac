#include <ccd/ccd.h>
#include <ccd/vec3.h>

#include <set>

#include "bodies.hpp"
#include "catch.hpp"
#include "feature/simplex_distance.hpp"
#include "feature/tracker.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr WalkTolerance kStrict{1e-9, 1e-9};

std::shared_ptr<Surface> surface(TriangleMesh mesh) {
  return std::make_shared<Surface>(std::make_shared<TriangleMesh>(std::move(mesh)));
}

double triangle_distance(const Surface& A, const Surface& B, const Pose& X_BA, std::uint32_t fa, std::uint32_t fb) {
  Simplex a = corners(A, {FeatureKind::face, fa});
  for (Vec3& p : a.p) p = X_BA * p;
  return std::sqrt(closest_points(a, corners(B, {FeatureKind::face, fb})).squared_distance);
}

double brute_force_distance(const Surface& A, const Surface& B, const Pose& X_BA) {
  double best = 1e300;
  for (std::uint32_t fa = 0; fa < A.mesh->triangles.size(); ++fa)
    for (std::uint32_t fb = 0; fb < B.mesh->triangles.size(); ++fb)
      best = std::min(best, triangle_distance(A, B, X_BA, fa, fb));
  return best;
}

/// Convex hull of points, swollen by a ball of radius `swell`.
struct Swollen {
  std::vector<Vec3> p;
  double swell;
};
void support(const void* object, const ccd_vec3_t* dir, ccd_vec3_t* out) {
  const auto& hull = *static_cast<const Swollen*>(object);
  const Vec3 d(dir->v[0], dir->v[1], dir->v[2]);
  const Vec3* best = &hull.p.front();
  for (const Vec3& p : hull.p)
    if (p.dot(d) > best->dot(d)) best = &p;
  const Vec3 s = *best + hull.swell * d.normalized();
  ccdVec3Set(out, s.x(), s.y(), s.z());
}
/// Distance of two convex bodies by libccd, which only tells whether bodies intersect: by bisection of the radius at
/// which one of them, swollen, touches the other.
double ccd_distance(const Surface& A, const Surface& B, const Pose& X_BA) {
  Swollen a{{}, 0}, b{B.mesh->vertices, 0};
  for (const Vec3& v : A.mesh->vertices) a.p.push_back(X_BA * v);
  ccd_t ccd;
  CCD_INIT(&ccd);
  ccd.support1 = ccd.support2 = support;
  ccd.max_iterations = 1000;  // with them GJK tells near-touching round shapes apart to some 5e-5 m
  double low = 0, high = 1;
  for (int i = 0; i < 40; ++i) {
    a.swell = 0.5 * (low + high);
    (ccdGJKIntersect(&a, &b, &ccd) ? high : low) = a.swell;
  }
  return low;
}

std::uint32_t random_face_towards(std::mt19937& rng, const Surface& s, const Vec3& point) {
  for (;;) {
    const auto f = static_cast<std::uint32_t>(rng() % s.mesh->triangles.size());
    if (s.topology.face_normals[f].dot(point - s.mesh->vertices[s.mesh->triangles[f][0]]) > 0) return f;
  }
}

std::set<std::uint32_t> faces_around(const Surface& s, Feature f) {
  std::set<std::uint32_t> faces;
  const auto add_vertex = [&](std::uint32_t v) {
    const Topology& t = s.topology;
    faces.insert(t.vertex_faces.begin() + t.vertex_face_begin[v], t.vertex_faces.begin() + t.vertex_face_begin[v + 1]);
  };
  if (f.kind == FeatureKind::vertex) add_vertex(f.index);
  if (f.kind == FeatureKind::edge)
    for (const std::uint32_t face : s.topology.edges[f.index].f)
      if (face != kNone) faces.insert(face);
  if (f.kind == FeatureKind::face) faces.insert(f.index);
  return faces;
}

}  // namespace

TEST_CASE("on convex bodies every walk ends at the distance that libccd and brute force find", "[feature]") {
  std::mt19937 rng(21);
  for (int round = 0; round < 60; ++round) {
    const auto A = surface(random_convex_body(rng, 18, 0.02)), B = surface(random_convex_body(rng, 18, 0.03));
    const Pose X_BA{rotation(3 * random_direction(rng)), 0.09 * random_direction(rng)};
    const double expected = brute_force_distance(*A, *B, X_BA);
    REQUIRE(ccd_distance(*A, *B, X_BA) == Approx(expected).margin(1e-4));
    for (int start = 0; start < 20; ++start) {
      // A face seen from behind is a local minimum of its own (through the solid), so walks start in front.
      const Feature a{FeatureKind::face, random_face_towards(rng, *A, X_BA.inverse() * Vec3(Vec3::Zero()))};
      const Feature b{FeatureKind::face, random_face_towards(rng, *B, X_BA.p)};
      const FeaturePair pair = walk_to_minimum(*A, *B, X_BA, a, b, kStrict, 1000);
      REQUIRE(pair.distance == Approx(expected).epsilon(1e-7));
      REQUIRE((pair.p_a - pair.p_b).norm() == Approx(pair.distance));
    }
  }
}

TEST_CASE("walks on other bodies end at a local minimum, and the best of them is the distance", "[feature]") {
  std::mt19937 rng(22);
  for (int round = 0; round < 30; ++round) {
    const auto A = surface(random_star_body(rng, 16, 0.02)), B = surface(random_star_body(rng, 16, 0.03));
    const Pose X_BA{rotation(3 * random_direction(rng)), 0.075 * random_direction(rng)};
    const double expected = brute_force_distance(*A, *B, X_BA);
    double best = 1e300;
    for (std::uint32_t fa = 0; fa < A->mesh->triangles.size(); ++fa)
      for (std::uint32_t fb = 0; fb < B->mesh->triangles.size(); ++fb) {
        const FeaturePair pair =
            walk_to_minimum(*A, *B, X_BA, {FeatureKind::face, fa}, {FeatureKind::face, fb}, kStrict, 1000);
        best = std::min(best, pair.distance);
        // No two triangles around the two features are nearer to each other on the ray of one side's moves: with the
        // other side's point held, no face around a feature comes nearer.
        if ((fa + fb) % 7 != 0) continue;
        for (const std::uint32_t f : faces_around(*A, pair.a)) {
          Simplex s = corners(*A, {FeatureKind::face, f});
          for (Vec3& p : s.p) p = X_BA * p;
          REQUIRE(std::sqrt(closest_points(s, {1, {pair.p_b}}).squared_distance) > pair.distance * (1 - 1e-7));
        }
        for (const std::uint32_t f : faces_around(*B, pair.b))
          REQUIRE(std::sqrt(closest_points({1, {pair.p_a}}, corners(*B, {FeatureKind::face, f})).squared_distance) >
                  pair.distance * (1 - 1e-7));
      }
    REQUIRE(best == Approx(expected).epsilon(1e-9));
  }
}

TEST_CASE("pairs followed along a motion stay local minima, both contact models occur", "[feature]") {
  std::mt19937 rng(23);
  int vertex_face = 0, edge_edge = 0;
  for (int round = 0; round < 20; ++round) {
    const auto A = surface(random_convex_body(rng, 18, 0.02)), B = surface(random_convex_body(rng, 18, 0.03));
    const Vec3 axis = random_direction(rng), side = 0.08 * random_direction(rng);
    Feature a{FeatureKind::face, random_face_towards(rng, *A, -side)};
    Feature b{FeatureKind::face, random_face_towards(rng, *B, side)};
    for (int tick = 0; tick < 200; ++tick) {
      const Pose X_BA{rotation(0.01 * tick * axis), side};
      const FeaturePair pair = walk_to_minimum(*A, *B, X_BA, a, b, kStrict, 1000);
      a = pair.a;
      b = pair.b;
      if (tick % 20 == 0) REQUIRE(pair.distance == Approx(brute_force_distance(*A, *B, X_BA)).epsilon(1e-7));
      vertex_face += (a.kind == FeatureKind::face) != (b.kind == FeatureKind::face) ? 1 : 0;
      edge_edge += a.kind == FeatureKind::edge && b.kind == FeatureKind::edge ? 1 : 0;
    }
  }
  REQUIRE(vertex_face > 100);
  REQUIRE(edge_edge > 100);
}
