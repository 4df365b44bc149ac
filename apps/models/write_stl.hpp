#pragma once

#include <string>

#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

/// Writes `mesh` as binary STL in millimeters, without normals. Throws Error when the file cannot be written.
void write_stl(const TriangleMesh& mesh, const std::string& path);

}  // namespace tegotae
