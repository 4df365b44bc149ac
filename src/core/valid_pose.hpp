#pragma once

#include <cmath>

#include "tegotae/core/pose.hpp"

namespace tegotae {

/// Nothing that a hand moves is farther from the origin in any coordinate (m); beyond, a pose would lose its
/// micrometers. HapticLoop::step tells users this figure.
inline constexpr double kFarthest = 1e4;

/// No coordinate of a vertex (m) is larger: beyond lie damaged files and wrong units.
inline constexpr double kFarthestVertex = 1e6;

/// Finite, and no coordinate beyond kFarthest.
inline bool within_reach(const Vec3& p) noexcept {
  return p.allFinite() && p.cwiseAbs().maxCoeff() <= kFarthest;
}

/// Within reach, and the quaternion of unit length up to rounding.
inline bool is_valid(const Pose& pose) noexcept {
  constexpr double kUnitTolerance = 1e-3;  // of the squared length
  return within_reach(pose.p) && std::abs(pose.q.squaredNorm() - 1) < kUnitTolerance;
}

}  // namespace tegotae
