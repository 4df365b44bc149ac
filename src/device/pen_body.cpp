#include "device/pen_body.hpp"

#include <Eigen/LU>

namespace tegotae {

namespace {

Mat3 world_inertia(const Quat& rotation, const Vec3& inertia) {
  const Mat3 R = rotation.toRotationMatrix();
  return R * inertia.asDiagonal() * R.transpose();
}

Vec3 angular_velocity_of(const Quat& rotation, const Vec3& inertia, const Vec3& angular_momentum) {
  return rotation * (rotation.conjugate() * angular_momentum).cwiseQuotient(inertia);
}

}  // namespace

Vec3 PenBody::angular_velocity(const PenBodySettings& settings) const noexcept {
  return angular_velocity_of(rotation, settings.inertia, angular_momentum);
}

void PenBody::step(double h, const PenBodySettings& s, const PenTarget& target, const Wrench& wrench) noexcept {
  // Translation: with the mean velocity u = (v0 + v1) / 2 over the step and the forces at its middle,
  // 2 m (u - v0) / h = k (target - x0 - h u / 2) + d (target' - u) + F - friction · u/|u|.
  const Vec3 pull = 2.0 * s.mass / h * velocity + s.stiffness * (target.center - center) +
                    s.damping * target.velocity.v + wrench.force;
  const double strength = pull.norm();
  if (strength <= s.friction) {
    velocity.setZero();  // sticks
  } else {
    const double slip = 1.0 - s.friction / strength;
    const Vec3 u = slip / (2.0 * s.mass / h + 0.5 * h * s.stiffness + s.damping) * pull;
    center += h * u;
    velocity = 2.0 * u - velocity;
  }

  // Rotation: the same with the angular momentum L and the inertia at the predicted middle of the step,
  // I u = L0 + h/2 (k (e0 - h u / 2) + d (target' - u) + T).
  const Vec3 error = rotation_vector(target.rotation * rotation.conjugate());
  const Quat middle = tegotae::rotation(0.5 * h * angular_velocity(s)) * rotation;
  const Vec3 torque = s.torsional_stiffness * error + s.torsional_damping * target.velocity.w + wrench.torque;
  const double resistance = s.torsional_damping + 0.5 * h * s.torsional_stiffness;
  const Mat3 system = world_inertia(middle, s.inertia) + 0.5 * h * resistance * Mat3::Identity();
  const Vec3 u = system.inverse() * (angular_momentum + 0.5 * h * torque);
  angular_momentum += h * (torque - resistance * u);
  rotation = (tegotae::rotation(h * u) * rotation).normalized();
}

}  // namespace tegotae
