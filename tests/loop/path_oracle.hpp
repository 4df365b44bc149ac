// Whether a committed motion was free, asked of FCL at poses in between. Knows nothing of the certificate.
#pragma once

#include <cmath>

#include "fcl_oracle.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae::test {

/// The two readings of "the path between two poses": which point of the body moves linearly. Both turn at a constant
/// rate.
enum class PathKind { center, origin };

/// The pose at `s` in [0, 1] of the way; `center` is the center of mass (m, file frame).
inline Pose pose_between(const Pose& from, const Pose& to, const Vec3& center, double s, PathKind kind) {
  const Vec3 point = kind == PathKind::center ? center : Vec3::Zero();
  const Quat q = from.q.slerp(s, to.q).normalized();
  return {q, (1 - s) * (from * point) + s * (to * point) - q * point};
}

/// How far a point at most `reach` (m) away from `center` goes between the two poses, at most (m).
inline double travel(const Pose& from, const Pose& to, const Vec3& center, double reach) {
  return (to * center - from * center).norm() + reach * from.q.angularDistance(to.q);
}

/// Calls `f` with `parts` - 1 poses inside the way from `from` to `to`, the two readings in turn.
template <typename F>
void for_poses_between(const Pose& from, const Pose& to, const Vec3& center, int parts, PathKind first, F f) {
  for (int i = 1; i < parts; ++i) {
    const bool even = i % 2 == 0;
    const PathKind kind = even == (first == PathKind::center) ? PathKind::origin : PathKind::center;
    f(pose_between(from, to, center, static_cast<double>(i) / parts, kind));
  }
}

}  // namespace tegotae::test
