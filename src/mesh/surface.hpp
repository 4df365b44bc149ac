#pragma once

#include <memory>

#include "mesh/flat_regions.hpp"
#include "mesh/topology.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

/// A mesh with its adjacency and its flat regions; immutable, shared by all parts that use the mesh.
struct Surface {
  std::shared_ptr<const TriangleMesh> mesh;
  Topology topology;
  FlatRegions regions;

  explicit Surface(std::shared_ptr<const TriangleMesh> m)
      : mesh(std::move(m)), topology(build_topology(*mesh)), regions(find_flat_regions(*mesh, topology)) {}
};

}  // namespace tegotae
