#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Triangle surface in its file frame, SI units. Faces are counterclockwise seen from outside if the file has them so.
/// The library guarantees nothing else: the surface may be open, non-manifold or self-intersecting.
struct TriangleMesh {
  std::string name;                                     ///< origin of the mesh, for messages
  std::vector<Vec3> vertices;                           ///< m
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into `vertices`
  std::vector<std::string> notes{};                     ///< deviations of the mesh from its file, one line each
};

}  // namespace tegotae
