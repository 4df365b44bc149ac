#pragma once

#include <memory>
#include <utility>

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
  /// As an earlier build over the same mesh made it.
  Surface(std::shared_ptr<const TriangleMesh> m, Topology t, FlatRegions r)
      : mesh(std::move(m)), topology(std::move(t)), regions(std::move(r)) {}
};

/// The surface of `mesh`: the one in use by others, read from the cache, or built and kept there.
std::shared_ptr<const Surface> cached_surface(const std::shared_ptr<const TriangleMesh>& mesh);

}  // namespace tegotae
