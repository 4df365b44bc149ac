#pragma once

#include <array>

#include "tegotae/core/pose.hpp"

namespace tegotae {

/// A plane between two triangles that limits a motion: corner `corner` of A must stay on the side of `n`.
struct AxisLimit {
  bool found = false;
  Vec3 n = Vec3::Zero();  ///< unit, from B to A
  int corner = 0;
  double gap = 0;  ///< of that corner before the motion, m
};

/// Among the axes that separate triangle `a` from `b` by at least `clearance` (m; their normals, the cross products of
/// their edges, the direction of their closest points) the one on which A keeps most of its gap when its corners move
/// by `motion`.
AxisLimit least_limiting_axis(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                              const std::array<Vec3, 3>& motion, double clearance);

}  // namespace tegotae
