#pragma once

#include <cmath>

#include "tegotae/core/pose.hpp"

namespace tegotae {

/// The tangent number `k` (0 or 1) that friction problems take for the unit normal `n`.
inline Vec3 tangent(const Vec3& n, int k) noexcept {
  // Of two axes the one that is far from the normal.
  constexpr double kFar = 0.6;
  const Vec3 other = std::abs(n.x()) < kFar ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 first = n.cross(other).normalized();
  return k == 0 ? first : Vec3(n.cross(first));
}

}  // namespace tegotae
