#pragma once

#include <cstdint>
#include <vector>

#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae::view {

/// A mesh as a page draws it: single precision, file frame, m.
struct DisplayMesh {
  std::vector<float> positions;        ///< x, y, z of each vertex
  std::vector<std::uint32_t> indices;  ///< three a triangle
};

/// `mesh` with at most `most` triangles: a finer one has its vertices drawn together on the finest grid that is coarse
/// enough. Only for the eye.
DisplayMesh display_mesh(const TriangleMesh& mesh, std::size_t most);

}  // namespace tegotae::view
