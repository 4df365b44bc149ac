#pragma once

#include "tegotae/core/pose.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

/// Winding number of a closed surface around `point` (file frame, m): 1 inside, 0 outside, by the solid angles of its
/// triangles (van Oosterom and Strackee, "The solid angle of a plane triangle", 1983). O(triangles).
double winding_number(const TriangleMesh& mesh, const Vec3& point);

}  // namespace tegotae
