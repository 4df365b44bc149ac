#pragma once

#include <array>

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Constraint on the held part's motion near its pose X: the part's point `point` may move against `normal` by at most
/// `clearance`.
struct ContactPlane {
  Vec3 normal = Vec3::Zero();  ///< unit, out of the obstacle, world
  Vec3 point = Vec3::Zero();   ///< of the held part at X, m, world
  double clearance = 0;        ///< m; negative: the point should move outward by this much
  double mu = 0;               ///< coefficient of friction while the plane holds the point
};

/// Constraints on the next millimeter of the held part's motion, for the faster servo: first those that held the part
/// in the last tick, then the nearest others. A free body needs no more than six.
struct ContactPlanes {
  static constexpr int kMax = 6;          ///< degrees of freedom of a free body
  std::array<ContactPlane, kMax> planes;  ///< the first `count` of them are valid
  int count = 0;                          ///< 0: none is known, and X stays where it is until the next tick
  Pose X;                                 ///< pose of the held part's file frame at which they were taken
  Pose pen;                               ///< Y that this tick answered

  /// Returns whether the planes were taken at `pose`, bit for bit. Planes of another pose would pull the part where no
  /// contact is.
  bool taken_at(const Pose& pose) const noexcept { return X.p == pose.p && X.q.coeffs() == pose.q.coeffs(); }
};

}  // namespace tegotae
