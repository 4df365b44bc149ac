#pragma once

#include "tegotae/core/pose.hpp"

namespace tegotae {

/// Whether two poses are the same to the last bit, but for the sign of a zero.
inline bool same_pose(const Pose& a, const Pose& b) {
  return a.p == b.p && a.q.coeffs() == b.q.coeffs();
}

}  // namespace tegotae
