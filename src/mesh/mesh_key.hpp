#pragma once

#include "mesh/content_sum.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

/// Of the mesh's vertices and triangles, bit for bit.
inline ContentKey key_of(const TriangleMesh& mesh) {
  ContentSum sum;
  sum.add(mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3));
  sum.add(mesh.triangles.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]));
  return sum.key();
}

}  // namespace tegotae
