#pragma once

#include <array>

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// A limit on the held part's motion near its pose X: the point `point` of it may move against `normal` by `room`.
struct ContactPlane {
  Vec3 normal = Vec3::Zero();  ///< unit, out of the obstacle, world
  Vec3 point = Vec3::Zero();   ///< of the held part at X, m, world
  double room = 0;             ///< m; below 0: the point should move out by so much
  double mu = 0;               ///< coefficient of friction while the point is held there
};

/// What the contact loop knows about the held part's next millimeter, for a servo that is faster: the limits that held
/// it in its last tick, and after them the nearest others. A free body needs no more than six.
struct ContactPlanes {
  static constexpr int kMax = 6;          ///< degrees of freedom of a free body
  std::array<ContactPlane, kMax> planes;  ///< the first `count` of them hold
  int count = 0;                          ///< 0: nothing is known, X stays where it is until the next tick
  Pose X;                                 ///< of the held part's file frame, where they were taken
  Pose pen;                               ///< Y that the tick answered

  /// Whether they were taken at `pose`, bit for bit: planes of another pose would pull the part where no contact is.
  bool taken_at(const Pose& pose) const noexcept { return X.p == pose.p && X.q.coeffs() == pose.q.coeffs(); }
};

}  // namespace tegotae
