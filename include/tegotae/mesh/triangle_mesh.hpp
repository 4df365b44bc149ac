#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Triangle surface in its file frame, SI units. Where the file says so, faces are counterclockwise seen from outside.
/// The library guarantees nothing else: the surface may be open, non-manifold or self-intersecting.
struct TriangleMesh {
  std::string name;                                     ///< its origin, for messages
  std::vector<Vec3> vertices;                           ///< m
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into `vertices`
  std::vector<std::string> notes{};                     ///< deviations of the mesh from its file, one line each
};

}  // namespace tegotae
