#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// A triangle surface in its file frame, SI units. Faces turn counter-clockwise seen from outside where the file says
/// so; nothing else is promised: it may be open, non-manifold or self-intersecting.
struct TriangleMesh {
  std::string name;                                     ///< where it came from, for messages
  std::vector<Vec3> vertices;                           ///< m
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into `vertices`
  std::vector<std::string> notes{};                     ///< what is not as the file says, a line each
};

}  // namespace tegotae
