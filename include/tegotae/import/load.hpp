#pragma once

#include <string>

#include "tegotae/core/export.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"
#include "tegotae/mesh/weld.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Returns the length of one file unit in m: "m", "cm", "mm", "um" or "in". Throws Error for any other name.
double unit_length(const std::string& unit);

/// Reads STL, OBJ, PLY, OFF, glTF/GLB or 3MF (of these two all placed meshes in one surface), scales it by `unit_in_m`
/// (the length of one file unit) and welds coincident vertices. docs/formats.md lists what is read of each format. The
/// mesh's `notes` report what was left out or changed (animations, supports and the like).
///
/// Dirty surfaces load (report.hpp has what is counted). Throws Error with the file and the reason when the file cannot
/// be used: unreadable, empty, truncated, no triangles, indices out of range, non-finite or absurd coordinates, no
/// triangle with an area, STEP, unknown format, an unsupported required extension; polygons that would take more than
/// some ten seconds to triangulate; in text PLY and OFF, more or less than one line for a vertex or face. Coordinates
/// have single precision in the file's unit.
TriangleMesh load_mesh(const std::string& path, double unit_in_m = 1.0);

}  // namespace tegotae
