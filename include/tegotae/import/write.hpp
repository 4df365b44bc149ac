#pragma once

#include <string>

#include "tegotae/core/export.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Writes `mesh` as binary PLY (floats, shared vertices) in units of `unit_in_m` (m). Throws Error (kind file) when the
/// file cannot be written.
void write_ply(const TriangleMesh& mesh, const std::string& path, double unit_in_m);

}  // namespace tegotae
