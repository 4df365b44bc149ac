#pragma once

#include <algorithm>
#include <cmath>

#include "narrowphase/patch_separate.hpp"
#include "narrowphase/wide.hpp"

namespace tegotae {

/// Normals are kept in single precision, so their length may exceed 1 by 1e-7 and the bulge along them with it.
inline constexpr double kUnitSlack = 1 + 1e-6;
/// The part of a motion between s0 and s1, seen by a body whose points are up to `reach` from the center of mass.
///
/// With the plane going linearly from (n0, c0) to (n1, c1), the gap of a point that goes linearly is the quadratic
/// α(1−t)² + 2γt(1−t) + βt². The turning path leaves the chord by at most ρθ²Δs²t(1−t)/2, and the path with a linear
/// file-frame origin leaves the one with a linear center of mass by at most |c|θ²s(1−s)/2 (the rotation is the same,
/// the second derivative of R(sθ)r is at most ρθ²). Both are across the axis of rotation: a plane across it sees none.
/// Both terms are quadratics of the same form and are taken off.
struct Bulge {
  double at_start, at_end, between;
  Vec3 axis;

  Bulge(const Sweep& sweep, double reach, double s0, double s1) {
    axis = sweep.axis;
    const double k = 0.5 * kUnitSlack * sweep.theta2;
    const double paths = k * sweep.center_distance, turn = k * reach * (s1 - s0) * (s1 - s0);
    at_start = paths * s0 * (1 - s0);
    at_end = paths * s1 * (1 - s1);
    between = paths * (s0 * (1 - s1) + s1 * (1 - s0)) + turn;  // of 2γ
  }

  /// The part of the bulge that planes between n0 and n1 see.
  double share(const Vec3& n0, const Vec3& n1) const {
    return std::sqrt(std::max(axis.cross(n0).squaredNorm(), axis.cross(n1).squaredNorm()));
  }
};

/// Whether the plane that goes from n0 to n1 keeps the pair apart all along, with `spare` (m) at both ends.
template <typename Pair>
TEGOTAE_INLINE bool stays_apart(const Pair& pair, const Vec3& n0, const Vec3& n1, const Bulge& bulge,
                                const Sweep& sweep, double spare) {
  const double share = bulge.share(n0, n1);
  const double alpha = pair.start(n0) - share * bulge.at_start - spare - sweep.start_floor;
  if (!(alpha >= 0)) return false;
  const double beta = pair.end(n1) - share * bulge.at_end - spare - sweep.floor;
  if (!(beta >= 0)) return false;
  const double gamma = 0.5 * (pair.mixed(n0, n1) - share * bulge.between) - spare - sweep.floor;
  return gamma + std::sqrt(alpha * beta) >= 0;
}

}  // namespace tegotae
