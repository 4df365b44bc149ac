#include "feature/tracker.hpp"

#include <cmath>

#include "feature/simplex_distance.hpp"

namespace tegotae {
namespace {

/// A feature to walk to; `lean` is the cosine between the way there and the way to the other part.
struct Neighbor {
  Feature feature;
  double lean;
};

/// Voronoi test of feature `f` of `s`: the adjacent feature of higher dimension that leans most towards `dir` (unit, in
/// the surface's own frame, towards the other part), or `f` with a lean of 0 when none leans more than tolerated.
Neighbor steepest_neighbor(const Surface& s, Feature f, const Vec3& dir, const WalkTolerance& tolerance) {
  const auto& vertices = s.mesh->vertices;
  const Topology& t = s.topology;
  if (f.kind == FeatureKind::vertex) {
    double best = tolerance.vertex;
    Feature next = f;
    for (std::uint32_t k = t.vertex_edge_begin[f.index]; k < t.vertex_edge_begin[f.index + 1]; ++k) {
      const std::uint32_t e = t.vertex_edges[k];
      const auto& ends = t.edges[e].v;
      const Vec3 along = vertices[ends[0] == f.index ? ends[1] : ends[0]] - vertices[f.index];
      const double uphill = along.dot(dir);
      if (!(uphill > 0)) continue;  // the root below is most of the cost
      const double lean = uphill / along.norm();
      if (lean > best) {
        best = lean;
        next = {FeatureKind::edge, e};
      }
    }
    return {next, next == f ? 0 : best};
  }
  if (f.kind == FeatureKind::edge) {
    const auto& edge = t.edges[f.index];
    const Vec3 e = vertices[edge.v[1]] - vertices[edge.v[0]];
    double best = tolerance.edge;
    Feature next = f;
    for (const std::uint32_t face : edge.f) {
      if (face == kNone) continue;
      // In the face's plane, at right angles to the edge, towards the third corner.
      std::uint32_t third = 0;
      for (const std::uint32_t v : s.mesh->triangles[face])
        if (v != edge.v[0] && v != edge.v[1]) third = v;
      const Vec3 out = vertices[third] - vertices[edge.v[0]];
      const Vec3 inward = out * e.squaredNorm() - e * out.dot(e);
      const double uphill = inward.dot(dir);
      if (!(uphill > 0)) continue;
      const double lean = uphill / inward.norm();
      if (lean > best) {
        best = lean;
        next = {FeatureKind::face, face};
      }
    }
    return {next, next == f ? 0 : best};
  }
  return {f, 0};
}

}  // namespace

FeaturePair walk_to_minimum(const Surface& A, const Surface& B, const Pose& X_BA, Feature a, Feature b,
                            const WalkTolerance& tolerance, int most) {
  FeaturePair pair;
  double last = INFINITY;
  const Mat3 R = X_BA.q.toRotationMatrix();
  for (int move = 0;; ++move) {
    Simplex sa = corners(A, a);
    for (int k = 0; k < sa.size; ++k) sa.p[k] = R * sa.p[k] + X_BA.p;
    const ClosestPoints c = closest_points(sa, corners(B, b));
    const Feature ra = subfeature(A, a, c.mask_a), rb = subfeature(B, b, c.mask_b);
    const double distance = std::sqrt(c.squared_distance);
    // A neighbor that brings nothing (rounding, a degenerate face) ends the walk at the pair before it.
    if (!(distance < last)) return pair;
    last = distance;
    pair = {ra, rb, c.a, c.b, distance};
    if (distance == 0) return pair;
    const Vec3 to_b = (c.b - c.a) / distance;
    const Neighbor na = steepest_neighbor(A, ra, R.transpose() * to_b, tolerance);
    const Neighbor nb = steepest_neighbor(B, rb, -to_b, tolerance);
    if (na.lean == 0 && nb.lean == 0) return pair;
    if (move == most) {
      pair.ended = false;
      return pair;
    }
    // The steeper side moves: after a part slid by more than the gap, a corner first finds the face it is over now; if
    // it moved along its own edges instead, it would give up its place for a point back there.
    const bool move_a = na.lean > nb.lean;
    a = move_a ? na.feature : ra;
    b = move_a ? rb : nb.feature;
  }
}

}  // namespace tegotae
