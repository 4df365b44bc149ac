// Distances of triangles from their definition, as an oracle: every pair of points, segments and faces.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "tegotae/core/pose.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae::test {

using Triangle = std::array<Vec3, 3>;

inline double point_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  return (a + std::clamp(d.dot(p - a) / d.squaredNorm(), 0.0, 1.0) * d - p).norm();
}

inline double point_triangle(const Vec3& p, const Triangle& t) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  bool inside = true;
  double edges = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const Vec3 &a = t[k], &b = t[(k + 1) % 3];
    inside = inside && (b - a).cross(p - a).dot(n) >= 0;
    edges = std::min(edges, point_segment(p, a, b));
  }
  return inside ? std::abs(n.dot(p - t[0])) : edges;
}

inline double segment_segment(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = d - c, w = a - c;
  const double uv = u.dot(v), uu = u.dot(u), vv = v.dot(v), den = uu * vv - uv * uv;
  double best =
      std::min({point_segment(a, c, d), point_segment(b, c, d), point_segment(c, a, b), point_segment(d, a, b)});
  if (den > 0) {
    const double s = (uv * v.dot(w) - vv * u.dot(w)) / den, t = (uu * v.dot(w) - uv * u.dot(w)) / den;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) best = std::min(best, (w + s * u - t * v).norm());
  }
  return best;
}

inline bool crosses(const Vec3& a, const Vec3& b, const Triangle& t) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
  const double da = n.dot(a - t[0]), db = n.dot(b - t[0]);
  if (da * db > 0 || da == db) return false;  // in the plane: points and segments have the distance
  const Vec3 p = a + da / (da - db) * (b - a);
  for (int k = 0; k < 3; ++k)
    if ((t[(k + 1) % 3] - t[k]).cross(p - t[k]).dot(n) < 0) return false;
  return true;
}

inline double distance(const Triangle& s, const Triangle& t) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    best = std::min({best, point_triangle(s[i], t), point_triangle(t[i], s)});
    const Vec3 &a = s[i], &b = s[(i + 1) % 3];
    if (crosses(a, b, t) || crosses(t[i], t[(i + 1) % 3], s)) return 0;
    for (int j = 0; j < 3; ++j) best = std::min(best, segment_segment(a, b, t[j], t[(j + 1) % 3]));
  }
  return best;
}

inline std::vector<Triangle> triangles(const TriangleMesh& mesh, const Pose& X) {
  std::vector<Triangle> out;
  for (const auto& t : mesh.triangles)
    out.push_back({X * mesh.vertices[t[0]], X * mesh.vertices[t[1]], X * mesh.vertices[t[2]]});
  return out;
}

/// The distance of two meshes over all pairs of triangles, m; 0 when they intersect.
inline double brute_distance(const TriangleMesh& a, const Pose& X_a, const TriangleMesh& b, const Pose& X_b) {
  double best = std::numeric_limits<double>::infinity();
  const auto in_b = triangles(b, X_b);
  for (const Triangle& s : triangles(a, X_a))
    for (const Triangle& t : in_b) best = std::min(best, distance(s, t));
  return best;
}

}  // namespace tegotae::test
