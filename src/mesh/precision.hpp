#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

/// A triangle lower than this many rounding steps is a sliver: its normal is off by more than about 0.1 rad, so it says
/// more about rounding than about the part.
inline constexpr double kSliverSteps = 8.0;

/// One step (m) of single precision at the largest coordinate of `mesh`: what a file of floats cannot tell apart.
/// 25 mm from the origin this is 3 nm. Coordinates that are not finite are ignored.
inline double rounding_step(const TriangleMesh& mesh) {
  double largest = 0;
  for (const Vec3& p : mesh.vertices) {
    if (p.allFinite()) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  }
  return std::ldexp(largest, -23);
}

/// Whether two corners of `t` are one vertex.
inline bool is_collapsed(const std::array<std::uint32_t, 3>& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/// Whether `t` is collapsed or lower than kSliverSteps rounding steps of size `step` (m) over its longest side.
inline bool is_degenerate(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& t, double step) {
  if (is_collapsed(t)) return true;
  const Vec3 a = mesh.vertices[t[1]] - mesh.vertices[t[0]];
  const Vec3 b = mesh.vertices[t[2]] - mesh.vertices[t[1]];
  const Vec3 c = mesh.vertices[t[0]] - mesh.vertices[t[2]];
  const double longest = std::max({a.norm(), b.norm(), c.norm()});
  return !(a.cross(b).norm() > kSliverSteps * step * longest);
}

}  // namespace tegotae
