// Distance from a point to all triangles of a mesh, written once more, apart from the library.
#pragma once

#include <algorithm>
#include <cmath>

#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae::test {

inline double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double length2 = (b - a).squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(b - a) / length2, 0.0, 1.0) : 0.0;
  return (a + t * (b - a) - p).norm();
}

inline double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a);
  const double edges =
      std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
  // The foot lies inside when it is left of all three sides.
  const bool inside =
      (b - a).cross(p - a).dot(n) >= 0 && (c - b).cross(p - b).dot(n) >= 0 && (a - c).cross(p - c).dot(n) >= 0;
  return inside && n.norm() > 0 ? std::abs((p - a).dot(n)) / n.norm() : edges;
}

inline double distance_to_surface(const TriangleMesh& mesh, const Vec3& p) {
  double d = INFINITY;
  for (const auto& t : mesh.triangles)
    d = std::min(d, distance_to_triangle(p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
  return d;
}

}  // namespace tegotae::test
