#pragma once

#include <cstdint>
#include <vector>

#include "mesh/topology.hpp"

namespace tegotae {

/// Triangles joined over shared edges.
struct Components {
  std::vector<std::uint32_t> of;  ///< of each face, numbered in the order of their first faces; kNone if collapsed
  std::uint32_t count = 0;
};

Components components(const TriangleMesh& mesh, const Topology& topology);

/// Of each component, whether it has an edge that does not join exactly two faces with the same orientation.
std::vector<bool> open_components(const Topology& topology, const Components& parts);

/// The components of the welded `mesh` as surfaces of their own, in the order of their first faces (`first_face`, in
/// `mesh`). A closed component turned inside out is the wall of a cavity: it stays with the smallest component whose
/// box holds its box. Collapsed faces are left out.
std::vector<TriangleMesh> split(const TriangleMesh& mesh, std::vector<std::uint32_t>& first_face);

}  // namespace tegotae
