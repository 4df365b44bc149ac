#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

using Vec3 = Eigen::Vector3d;              ///< x, y, z
using Vec6 = Eigen::Matrix<double, 6, 1>;  ///< linear part first, then angular
using Mat3 = Eigen::Matrix3d;              ///< rows and columns x, y, z
/// Quaternion in the order w, x, y, z; of unit length wherever it is a rotation. It is not aligned: Eigen aligns by the
/// compiler's flags, so a Pose would have another layout in a program that is built with -mavx2.
using Quat = Eigen::Quaternion<double, Eigen::DontAlign>;

/// Rigid pose X_WB: maps coordinates in frame B to frame W, p_W = q * p_B + p. Lengths in m, `q` a unit quaternion.
struct Pose {
  Quat q = Quat::Identity();  ///< R_WB
  Vec3 p = Vec3::Zero();      ///< p_WB: position of B's origin in W, m

  /// Returns the point `p_B` (m, frame B) expressed in W.
  Vec3 operator*(const Vec3& p_B) const { return q * p_B + p; }
  /// Returns X_WC = X_WB * X_BC.
  Pose operator*(const Pose& X_BC) const { return {(q * X_BC.q).normalized(), q * X_BC.p + p}; }
  /// Returns X_BW.
  Pose inverse() const {
    const Quat qi = q.conjugate();
    return {qi, -(qi * p)};
  }
};

// A library built without -mavx2 must agree on the layout with a program built with it.
static_assert(sizeof(Pose) == 56 && alignof(Pose) == 8 && alignof(Vec3) == 8 && alignof(Mat3) == 8 &&
                  sizeof(Vec6) == 48 && alignof(Vec6) == 16,
              "Eigen is configured to lay its types out in another way than the library's");

/// Velocity of a body: `v` (m/s) of a stated point of it, `w` angular (rad/s); both expressed in the world.
struct Twist {
  Vec3 v = Vec3::Zero();  ///< m/s
  Vec3 w = Vec3::Zero();  ///< rad/s
};

/// Force (N) and torque (N·m) about a stated point; both expressed in the world.
struct Wrench {
  Vec3 force = Vec3::Zero();   ///< N
  Vec3 torque = Vec3::Zero();  ///< N·m
};

/// Rigid displacement of a body: `dp` (m) of a stated center, and the rotation vector `dr` (rad) about that center,
/// both in W.
struct Displacement {
  Vec3 dp = Vec3::Zero();  ///< m
  Vec3 dr = Vec3::Zero();  ///< rad
};

/// Returns the rotation vector of the unit quaternion `q` (rad, of length 0 to π).
Vec3 rotation_vector(const Quat& q);
/// Returns the unit quaternion of the rotation vector `r` (rad).
Quat rotation(const Vec3& r);

/// Returns the pose `X` after the displacement `d` of the body point `center_B` (m, body frame): the center moves by
/// `d.dp`, and the body rotates by `d.dr` about it.
Pose displaced(const Pose& X, const Vec3& center_B, const Displacement& d);
/// Returns the displacement of `center_B` that takes `from` to `to`: displaced(from, center_B, d) == to up to rounding.
Displacement displacement(const Pose& from, const Pose& to, const Vec3& center_B);
/// Returns `d` scaled by `s`. On the path s -> displaced(X, c, s·d), s in [0, 1], the center moves linearly and the
/// angular rate is constant.
inline Displacement operator*(double s, const Displacement& d) {
  return {s * d.dp, s * d.dr};
}

}  // namespace tegotae
