#pragma once

#include <memory>

#include "mesh/topology.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

/// A mesh with its adjacency; immutable, shared by all parts that use the mesh.
struct Surface {
  std::shared_ptr<const TriangleMesh> mesh;
  Topology topology;

  explicit Surface(std::shared_ptr<const TriangleMesh> m) : mesh(std::move(m)), topology(build_topology(*mesh)) {}
};

}  // namespace tegotae
