#pragma once

#include <string>

#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

/// Length of one file unit in m: "m", "cm", "mm", "um" or "in". Throws Error for any other name.
double unit_length(const std::string& unit);

/// Reads STL, OBJ, PLY, OFF or glTF/GLB (node transforms applied, all meshes of the file in one surface), scales it by
/// `unit_in_m` (the length of one file unit) and welds vertices that coincide.
///
/// Dirty surfaces load (see report.hpp for what is counted); a file that cannot be used throws Error with the file and
/// the reason: unreadable, empty, truncated, no triangles, indices out of range, non-finite or absurd coordinates,
/// STEP, unknown format.
TriangleMesh load_mesh(const std::string& path, double unit_in_m = 1.0);

/// Welds bit-equal vertices (and vertices within a rounding step of the mesh's size) and drops unused ones. Face count
/// and face order stay.
TriangleMesh weld(const TriangleMesh& mesh);

}  // namespace tegotae
