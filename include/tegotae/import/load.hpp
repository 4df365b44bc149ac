#pragma once

#include <string>

#include "tegotae/core/export.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"
#include "tegotae/mesh/weld.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Returns the length of one file unit, m: of "m", "cm", "mm", "um" or "in". Throws Error (kind other) for any other
/// name.
double unit_length(const std::string& unit);

/// Reads STL, OBJ, PLY, OFF, glTF/GLB or 3MF, scales the mesh by `unit_in_m` (the length of one file unit, m) and welds
/// coincident vertices. From glTF/GLB and 3MF it reads all placed meshes as one surface. docs/formats.md lists what is
/// read of each format. The mesh's `notes` report what was left out or changed (animations, supports and the like).
/// Coordinates have single precision in the file's unit.
///
/// Flawed surfaces load; report.hpp counts the flaws. Throws Error (kind file) with the file and the reason when the
/// file cannot be used:
/// - it is unreadable, empty, truncated, STEP, of an unknown format, or needs an unsupported extension;
/// - it has no triangle, or none with an area;
/// - an index is out of range, or a coordinate is not finite or absurd;
/// - its polygons would take more than some ten seconds to triangulate;
/// - a text PLY or OFF has more or less than one line for a vertex or face.
///
/// A `unit_in_m` that is not positive throws Error (kind other).
TriangleMesh load_mesh(const std::string& path, double unit_in_m = 1.0);

}  // namespace tegotae
