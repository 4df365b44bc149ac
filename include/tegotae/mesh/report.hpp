#pragma once

#include <cstddef>

#include "tegotae/core/export.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Properties of a surface after welding (see load.hpp).
struct MeshReport {
  std::size_t vertices = 0;            ///< all vertices; weld() drops those that no triangle uses
  std::size_t triangles = 0;           ///< all triangles, also degenerate and duplicate ones
  std::size_t components = 0;          ///< sets of triangles joined over shared edges, without collapsed triangles
  std::size_t boundary_edges = 0;      ///< edges of one face
  std::size_t non_manifold_edges = 0;  ///< edges of more than two faces, or of two faces with opposite orientation
  /// Faces that are collapsed, or whose height is below 8 steps of single precision (their normals are not used).
  std::size_t degenerate_faces = 0;
  /// Faces with the same three vertices as an earlier face, in any order. Collapsed faces do not count.
  std::size_t duplicate_faces = 0;
  /// Closed components whose faces point inward where they should point outward, or the reverse. What an open component
  /// surrounds is not judged.
  std::size_t inverted_shells = 0;
  bool closed = false;          ///< every edge joins exactly two faces with the same orientation
  Vec3 box_min = Vec3::Zero();  ///< m, file frame
  Vec3 box_max = Vec3::Zero();  ///< m, file frame
};

/// Returns the report on `mesh`, as it is. Weld it first (load_mesh does); otherwise every edge is a boundary.
MeshReport report(const TriangleMesh& mesh);

}  // namespace tegotae
