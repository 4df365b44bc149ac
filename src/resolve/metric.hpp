#pragma once

#include "tegotae/contact/contact.hpp"
#include "tegotae/core/pose.hpp"
#include "tegotae/mesh/mass.hpp"

namespace tegotae {

/// What a turn of the held part weighs against a shift, as a length: whitened coordinates are (dp, k_i × rotation about
/// axis i), m, and how far a displacement goes is the length of such a vector.
class Metric {
 public:
  /// Of the coupling's springs: |whiten(d)|² = (2 / stiffness) × the energy that they store. `radius` (m) is
  /// coupling_radius(); the same about every axis.
  explicit Metric(double radius);
  /// Of the part's mass: |whiten(d)|² = dᵀ M d / m, so that a rotation counts by how far it carries the mass; the k_i
  /// are the radii of gyration about the principal axes.
  explicit Metric(const MassProperties& mass);

  /// Turns the principal axes along with the part.
  void set_orientation(const Quat& q_WA) { axes_W_ = q_WA.toRotationMatrix() * axes_; }

  /// The principal axes as columns, in the world.
  const Mat3& axes() const { return axes_W_; }

  Vec6 whiten(const Displacement& d) const {
    Vec6 z;
    z.head<3>() = d.dp;
    z.tail<3>() = radii_.cwiseProduct(axes_W_.transpose() * d.dr);
    return z;
  }
  Displacement unwhiten(const Vec6& z) const { return {z.head<3>(), axes_W_ * z.tail<3>().cwiseQuotient(radii_)}; }
  /// The contact's Jacobian [n, r × n] in whitened coordinates: row · whiten(d) = n · (dp + dr × r).
  Vec6 row(const Contact& c) const { return row(c, c.n); }
  /// The same along another direction `e` (unit, world): row · whiten(d) = e · (dp + dr × r).
  Vec6 row(const Contact& c, const Vec3& e) const {
    Vec6 g;
    g.head<3>() = e;
    g.tail<3>() = (axes_W_.transpose() * c.r.cross(e)).cwiseQuotient(radii_);
    return g;
  }
  /// What row() makes its last three of: they are this matrix times r × e, but for rounding.
  Mat3 turns() const { return radii_.cwiseInverse().asDiagonal() * axes_W_.transpose(); }

 private:
  Mat3 axes_ = Mat3::Identity();  ///< as columns, file frame
  Vec3 radii_;                    ///< m
  Mat3 axes_W_ = Mat3::Identity();
};

}  // namespace tegotae
