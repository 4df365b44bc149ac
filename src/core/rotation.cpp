#include <cmath>

#include "tegotae/core/pose.hpp"

namespace tegotae {

Vec3 rotation_vector(const Quat& q) {
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  const Vec3 v = sign * q.vec();
  const double n = v.norm();
  // Below 1e-8 the series 2 v / w is exact to rounding and the quotient by n is not needed.
  if (n < 1e-8) return 2.0 * v;
  return (2.0 * std::atan2(n, sign * q.w()) / n) * v;
}

Quat rotation(const Vec3& r) {
  const double angle = r.norm();
  // Below 1e-8 sin(angle/2)/angle equals 1/2 to rounding.
  const double s = angle < 1e-8 ? 0.5 : std::sin(0.5 * angle) / angle;
  return Quat(std::cos(0.5 * angle), s * r.x(), s * r.y(), s * r.z()).normalized();
}

Pose displaced(const Pose& X, const Vec3& center_B, const Displacement& d) {
  const Vec3 c = X * center_B + d.dp;
  Pose Y;
  Y.q = (rotation(d.dr) * X.q).normalized();
  Y.p = c - Y.q * center_B;
  return Y;
}

Displacement displacement(const Pose& from, const Pose& to, const Vec3& center_B) {
  return {to * center_B - from * center_B, rotation_vector(to.q * from.q.conjugate())};
}

}  // namespace tegotae
