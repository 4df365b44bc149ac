#include <algorithm>
#include <cmath>

#include "narrowphase/patch_separate.hpp"

namespace tegotae {
namespace {

/// Separations below this times the size of the scene are rounding (double precision, some dozens of operations on
/// coordinates of that size, and a pose that was composed anew).
constexpr double kFloor = 1e-12;

}  // namespace

Sweep::Sweep(const Pose& X_BA, const Displacement& d, const Vec3& center, const PatchTree& b, double reach_a,
             double clearance)
    : dp(d.dp), dr(d.dr), theta(d.dr.norm()), theta2(d.dr.squaredNorm()), center_distance(center.norm()) {
  if (theta2 > 0) axis = d.dr / theta;
  start.R = X_BA.q.toRotationMatrix();
  start.t = X_BA * center - b.origin();
  const Pose last = displaced(X_BA, center, d);
  end.R = last.q.toRotationMatrix();
  end.t = last * center - b.origin();
  const double size = start.t.norm() + end.t.norm() + reach_a + b.radius() + b.origin().norm() + center_distance;
  floor = std::max(kFloor * size, clearance);
  start_floor = floor - 0.5 * kFloor * size;
}

Placement Sweep::at(double s) const {
  if (s <= 0) return start;
  if (s >= 1) return end;
  return {rotation(s * dr).toRotationMatrix() * start.R, start.t + s * dp};
}

}  // namespace tegotae
