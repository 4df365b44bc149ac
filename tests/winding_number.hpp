// Whether a point is inside a closed surface, by all of its triangles.
#pragma once

#include <cmath>

#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae::test {

/// Winding number of a closed surface around `point` (file frame, m): 1 inside, 0 outside, by the solid angles of its
/// triangles (van Oosterom and Strackee, "The solid angle of a plane triangle", 1983). O(triangles).
inline double winding_number(const TriangleMesh& mesh, const Vec3& point) {
  double half_angles = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - point, b = mesh.vertices[t[1]] - point, c = mesh.vertices[t[2]] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    half_angles += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return half_angles / (2 * M_PI);
}

}  // namespace tegotae::test
