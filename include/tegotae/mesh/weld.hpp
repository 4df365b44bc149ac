#pragma once

#include "tegotae/core/export.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Returns `mesh` welded: merges bit-equal vertices, then those within one step of single precision at the largest
/// coordinate (3 nm at 25 mm), and drops unused vertices. Number and order of the faces stay, also of faces whose
/// corners merged.
TriangleMesh weld(const TriangleMesh& mesh);

}  // namespace tegotae
