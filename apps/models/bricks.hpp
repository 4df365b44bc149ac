#pragma once

#include <string>
#include <vector>

#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae::shapes {

/// A box along the axes, m.
struct Brick {
  Vec3 low, high;
  bool solid = true;  ///< false: what it covers is empty
};

/// The closed solid that bricks make, each put over those before it. Its surface is divided along the planes of all of
/// them. Throws tegotae::Error when nothing is left.
TriangleMesh solid_of(const std::string& name, const std::vector<Brick>& bricks);

}  // namespace tegotae::shapes
