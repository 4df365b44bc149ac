#pragma once

#include <string>
#include <vector>

#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

/// For a message that there is nothing: what was left out or not read, of all that is told of a file; may be empty.
std::string cause_of(const std::vector<std::string>& notes);

/// Throws Error unless `mesh` has triangles and its coordinates are finite and on this side of 1000 km.
void require_usable(const TriangleMesh& mesh);
/// Throws Error unless a triangle of the welded `mesh` has an area.
void require_area(const TriangleMesh& welded);
/// `mesh` welded and called `name`. Throws Error, which tells file and name, unless it can be used.
TriangleMesh usable(TriangleMesh mesh, const std::string& path, const std::string& name);

}  // namespace tegotae
