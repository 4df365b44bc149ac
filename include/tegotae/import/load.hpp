#pragma once

#include <string>

#include "tegotae/core/export.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"
#include "tegotae/mesh/weld.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Length of one file unit in m: "m", "cm", "mm", "um" or "in". Throws Error for any other name.
double unit_length(const std::string& unit);

/// Reads STL, OBJ, PLY, OFF, glTF/GLB or 3MF (of these two all placed meshes in one surface), scales it by `unit_in_m`
/// (the length of one file unit) and welds vertices that coincide. docs/formats.md lists what is read of each format;
/// what is told of it (animations, supports and the like) is in the mesh's `notes`.
///
/// Dirty surfaces load (see report.hpp for what is counted); a file that cannot be used throws Error with the file and
/// the reason: unreadable, empty, truncated, no triangles, indices out of range, non-finite or absurd coordinates,
/// no triangle with an area, STEP, unknown format, a required extension that is not read; polygons that would take more
/// than some ten seconds to cut into triangles; in text PLY and OFF, vertices or faces that do not take a line each.
/// Coordinates have the precision of a float of the file's numbers.
TriangleMesh load_mesh(const std::string& path, double unit_in_m = 1.0);

}  // namespace tegotae
