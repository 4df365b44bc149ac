#pragma once

#include <cmath>

#include "tegotae/core/pose.hpp"

namespace tegotae {

/// The two tangents that friction problems take for a unit normal.
struct Tangents {
  explicit Tangents(const Vec3& n) noexcept {
    // Of two axes the one that is far from the normal.
    constexpr double kFar = 0.6;
    direction[0] = n.cross(std::abs(n.x()) < kFar ? Vec3::UnitX() : Vec3::UnitY()).normalized();
    direction[1] = n.cross(direction[0]);
  }

  Vec3 direction[2];
};

}  // namespace tegotae
