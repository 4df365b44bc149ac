#include "narrowphase/containment.hpp"

#include <cmath>

namespace tegotae {

double winding_number(const TriangleMesh& mesh, const Vec3& point) {
  double half_angles = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - point, b = mesh.vertices[t[1]] - point, c = mesh.vertices[t[2]] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    half_angles += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return half_angles / (2 * M_PI);
}

}  // namespace tegotae
