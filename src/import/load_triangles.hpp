#pragma once

#include <optional>

#include "import/file_check.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

/// The triangles of a plain file as assimp reads them, bit for bit and in the same order, without the second that it
/// takes for a million. None where it has something to do: polygons to cut, groups to put together, several solids.
std::optional<TriangleMesh> triangles_of(const PlainMesh& plain);

}  // namespace tegotae
