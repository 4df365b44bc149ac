#include "narrowphase/receding.hpp"

namespace tegotae {
namespace {

/// Of velocities, for the rounding of all that they are computed from.
constexpr double kVelocitySlack = 1e-6;

/// The velocity of the center of mass along the other reading of the path (see Sweep) is off by this at most: it is
/// the difference of ω × R(s)c and its mean over the motion.
double other_reading(const Sweep& w) {
  return 0.5 * w.theta2 * w.center_distance;
}

}  // namespace

bool PassingPoints::recedes(const NormalCone& cone, const Vec3& at, double radius) const {
  const Vec3 v = sign_ * (dp_ + dr_.cross(at));
  const double slack = kVelocitySlack * (dp_.norm() + dr_.norm() * (at.norm() + radius));
  return cone.least(v) > dr_.norm() * (radius + distance_) + center_ + slack;
}

bool PassingPoints::meets(const NormalCone& cone, const Vec3& at) const {
  return cone.turned().least(sign_ * (dp_ + dr_.cross(at))) > 0;
}

/// A's point at x has the velocity dp + dr × (x − c), c = c0 + s dp up to what the other reading leaves.
PassingPoints PassingPoints::seen_from_b(const Sweep& w) {
  PassingPoints out;
  out.dp_ = w.dp;
  out.dr_ = w.dr;
  out.sign_ = 1;
  out.center_ = other_reading(w) + w.theta * (w.dp.norm() + 0.125 * w.theta2 * w.center_distance);
  out.distance_ = w.floor;
  return out;
}

/// A's axes turn by s θ: B's point at p has the velocity −(R(s)ᵀ dp + dr × p), where dr keeps its direction and R(s)ᵀ
/// dp leaves R(0)ᵀ dp by at most θ |dp|.
PassingPoints PassingPoints::seen_from_a(const Sweep& w) {
  PassingPoints out;
  out.dp_ = w.start.R.transpose() * w.dp;
  out.dr_ = w.start.R.transpose() * w.dr;
  out.sign_ = -1;
  out.center_ = other_reading(w) + w.theta * w.dp.norm();
  out.distance_ = w.floor;
  return out;
}

}  // namespace tegotae
