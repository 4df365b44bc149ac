#pragma once

#include <cmath>

#include "tegotae/core/pose.hpp"

namespace tegotae {

/// The two tangents that friction problems take for a unit normal.
struct Tangents {
  explicit Tangents(const Vec3& n) noexcept {
    // Of two axes the one that is far from the normal.
    constexpr double kFar = 0.6;
    if (std::abs(n.x()) < kFar) {
      const double inverse = 1 / std::sqrt(n.y() * n.y() + n.z() * n.z());
      direction[0] = {0, inverse * n.z(), -inverse * n.y()};
    } else {
      const double inverse = 1 / std::sqrt(n.x() * n.x() + n.z() * n.z());
      direction[0] = {-inverse * n.z(), 0, inverse * n.x()};
    }
    direction[1] = n.cross(direction[0]);
  }

  Vec3 direction[2];
};

}  // namespace tegotae
