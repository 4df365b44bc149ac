#pragma once

#include <string>

#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

/// Writes `mesh` as OBJ in millimeters, 9 digits a coordinate. Throws Error when the file cannot be written.
void write_obj(const TriangleMesh& mesh, const std::string& path);

}  // namespace tegotae
