#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

/// A tessellated shape of a STEP file (AP242), as it is in the file: in the length unit and the frame of the
/// representation that has it.
struct StepTriangles {
  std::uint64_t id = 0;     ///< of its entity
  std::uint64_t exact = 0;  ///< of the exact shape that it shows too; 0: none
  TriangleMesh mesh;        ///< not welded; empty for curves and points
};

/// A STEP file in a way of writing that every OpenCASCADE understands.
struct PlainStep {
  std::string text;
  std::vector<StepTriangles> shapes;
  std::vector<std::string> unread;  ///< kinds of tessellated shapes that are not read, each "#17 is a ..."
};

/// Whether a STEP file may hold tessellated shapes.
bool mentions_triangles(std::string_view bytes);

/// Takes the triangles out of a STEP file. In their place, under the number of their entity, stands a GEOMETRIC_SET of
/// the points 0, x, y, z: what becomes of these tells unit and place. Throws Error with the file and the reason.
PlainStep take_triangles(const std::string& path, std::string_view bytes);

}  // namespace tegotae
