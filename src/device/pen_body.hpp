#pragma once

#include "tegotae/core/pose.hpp"

namespace tegotae {

/// A rigid body on a spring and a damper for its center and for its rotation, with Coulomb friction on its center.
struct PenBodySettings {
  double mass;                 ///< kg
  Vec3 inertia;                ///< about the center along the body's axes, kg·m²
  double stiffness;            ///< N/m
  double damping;              ///< N·s/m
  double torsional_stiffness;  ///< N·m/rad
  double torsional_damping;    ///< N·m·s/rad
  double friction;             ///< N
};

/// Where the spring pulls: the center, its velocity, the rotation and the angular velocity, in the world.
struct PenTarget {
  Vec3 center;
  Quat rotation;
  Twist velocity;
};

/// The body's motion, world frame.
struct PenBody {
  Vec3 center = Vec3::Zero();            ///< m
  Quat rotation = Quat::Identity();      ///< of the body's axes
  Vec3 velocity = Vec3::Zero();          ///< of the center, m/s
  Vec3 angular_momentum = Vec3::Zero();  ///< about the center, kg·m²/s

  Vec3 angular_velocity(const PenBodySettings& settings) const noexcept;
  /// One step of `h` seconds by the implicit midpoint rule: second order, no numerical damping, stable for any
  /// stiffness; without torque the angular momentum stays exactly. `target` is that of the middle of the step, `wrench`
  /// (at the center) is constant over it.
  void step(double h, const PenBodySettings& settings, const PenTarget& target, const Wrench& wrench) noexcept;
};

}  // namespace tegotae
