#pragma once

#include "feature/feature.hpp"

namespace tegotae {

/// Closest points of two simplices and the corners that carry them: bit k of a mask is set when corner k has a positive
/// weight, so a mask with one bit is a vertex, with two an edge, with three the face.
struct ClosestPoints {
  Vec3 a, b;
  double squared_distance;
  unsigned mask_a, mask_b;
};

/// Closest points of two simplices of one to three corners each (points, segments, triangles). Simplices that cross
/// each other's inside are not looked for: at a free pose there are none.
ClosestPoints closest_points(const Simplex& a, const Simplex& b);

/// Whether the closest points of two edges may lie inside both: of most edges they do not, which this tells at a tenth
/// of the cost of closest_points().
bool may_be_inside_both(const Simplex& a, const Simplex& b);

}  // namespace tegotae
