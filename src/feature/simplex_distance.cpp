#include "feature/simplex_distance.hpp"

#include <algorithm>

namespace tegotae {
namespace {

struct OnSimplex {
  Vec3 p;
  unsigned mask;
};

OnSimplex closest_on_segment(const Vec3& q, const Vec3& a, const Vec3& b, unsigned bit_a, unsigned bit_b) {
  const Vec3 ab = b - a;
  const double t = (q - a).dot(ab), len2 = ab.squaredNorm();
  if (t <= 0) return {a, bit_a};
  if (t >= len2) return {b, bit_b};
  return {a + (t / len2) * ab, bit_a | bit_b};
}

/// A triangle's normal and, of each edge, what points inwards, for the distances of several points: not of unit length.
struct Inside {
  Vec3 n;
  double n2 = 0;
  std::array<Vec3, 3> inward;
  explicit Inside(const Simplex& s) {
    if (s.size < 3) return;
    n = (s.p[1] - s.p[0]).cross(s.p[2] - s.p[0]);
    n2 = n.squaredNorm();
    for (unsigned k = 0; k < 3; ++k) inward[k] = n.cross(s.p[(k + 1) % 3] - s.p[k]);
  }
};

/// Point on triangle by its Voronoi regions: each edge's outer half-plane is tested in the triangle's plane.
OnSimplex closest_on_triangle(const Vec3& q, const std::array<Vec3, 3>& p, const Inside& of) {
  OnSimplex best{p[0], 1};
  double best2 = (q - p[0]).squaredNorm();
  bool inside = of.n2 > 0;
  for (unsigned k = 0; k < 3; ++k) {
    const unsigned l = (k + 1) % 3;
    if (of.n2 > 0 && of.inward[k].dot(q - p[k]) > 0) continue;  // strictly on the inner side of this edge
    inside = false;
    const OnSimplex s = closest_on_segment(q, p[k], p[l], 1u << k, 1u << l);
    const double d2 = (q - s.p).squaredNorm();
    if (d2 < best2) {
      best = s;
      best2 = d2;
    }
  }
  if (inside) return {q - ((q - p[0]).dot(of.n) / of.n2) * of.n, 7};
  return best;
}

OnSimplex closest_on(const Vec3& q, const Simplex& s, const Inside& of) {
  switch (s.size) {
    case 1:
      return {s.p[0], 1};
    case 2:
      return closest_on_segment(q, s.p[0], s.p[1], 1, 2);
    default:
      return closest_on_triangle(q, s.p, of);
  }
}

/// Where the lines through two edges are closest: shares of `u`, the edge of A, and of `v`, that of B; `w` goes from
/// the start of B's to that of A's. False when they are parallel, or closest outside of one of the edges.
bool inside_both(const Vec3& u, const Vec3& v, const Vec3& w, double& s, double& t) {
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double det = uu * vv - uv * uv;
  if (!(det > 0)) return false;
  s = (uv * vw - vv * uw) / det;
  t = (uu * vw - uv * uw) / det;
  return s > 0 && s < 1 && t > 0 && t < 1;
}

int edge_count(int size) {
  return size == 1 ? 0 : size == 2 ? 1 : 3;
}

}  // namespace

ClosestPoints closest_points(const Simplex& a, const Simplex& b) {
  ClosestPoints best{Vec3::Zero(), Vec3::Zero(), 1e300, 1, 1};
  const auto take = [&best](const Vec3& pa, const Vec3& pb, unsigned ma, unsigned mb) {
    const double d2 = (pa - pb).squaredNorm();
    if (d2 < best.squared_distance) best = {pa, pb, d2, ma, mb};
  };
  const Inside of_a(a), of_b(b);
  if (a.size == 1) {
    const OnSimplex s = closest_on(a.p[0], b, of_b);
    return {a.p[0], s.p, (a.p[0] - s.p).squaredNorm(), 1, s.mask};
  }
  if (b.size == 1) {
    const OnSimplex s = closest_on(b.p[0], a, of_a);
    return {s.p, b.p[0], (s.p - b.p[0]).squaredNorm(), s.mask, 1};
  }
  for (unsigned i = 0; i < static_cast<unsigned>(a.size); ++i) {
    const OnSimplex s = closest_on(a.p[i], b, of_b);
    take(a.p[i], s.p, 1u << i, s.mask);
  }
  for (unsigned j = 0; j < static_cast<unsigned>(b.size); ++j) {
    const OnSimplex s = closest_on(b.p[j], a, of_a);
    take(s.p, b.p[j], s.mask, 1u << j);
  }
  // What is left are pairs of points inside two edges.
  for (int i = 0; i < edge_count(a.size); ++i) {
    const int i1 = (i + 1) % 3;
    const Vec3 u = a.p[i1] - a.p[i];
    for (int j = 0; j < edge_count(b.size); ++j) {
      const int j1 = (j + 1) % 3;
      const Vec3 v = b.p[j1] - b.p[j], w = a.p[i] - b.p[j];
      double s = 0, t = 0;  // of parallel ones an end of one of them is as close
      if (inside_both(u, v, w, s, t))
        take(a.p[i] + s * u, b.p[j] + t * v, (1u << i) | (1u << i1), (1u << j) | (1u << j1));
    }
  }
  return best;
}

bool may_be_inside_both(const Simplex& a, const Simplex& b) {
  double s = 0, t = 0;
  return inside_both(a.p[1] - a.p[0], b.p[1] - b.p[0], a.p[0] - b.p[0], s, t);
}

}  // namespace tegotae
