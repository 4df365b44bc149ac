#pragma once

#include <cstddef>

#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

/// Of the welded `mesh`, the vertices that lie on an edge of one face between its ends: the faces on both sides fit
/// together there and are not joined, so that the surface is open.
std::size_t count_t_junctions(const TriangleMesh& mesh);

}  // namespace tegotae
