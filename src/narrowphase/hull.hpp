#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "narrowphase/patch_separate.hpp"

namespace tegotae {

/// A convex set of points: a box, or a triangle.
class Hull {
 public:
  Hull() = default;
  static Hull box(const Vec3& center, const std::array<Vec3, 3>& axis, const std::array<double, 3>& half) {
    return Hull(false, {center, axis[0], axis[1], axis[2]}, half);
  }
  static Hull triangle(const std::array<Vec3, 3>& corners) {
    return Hull(true, {corners[0], corners[1], corners[2], Vec3::Zero()}, {});
  }

  bool is_triangle() const { return triangle_; }
  /// Center of a box, centroid of a triangle.
  Vec3 middle() const { return triangle_ ? Vec3((v_[0] + v_[1] + v_[2]) / 3) : v_[0]; }
  /// Of a box: unit vectors up to rounding, and half extents along them.
  const Vec3& axis(int i) const { return v_[1 + i]; }
  double half(int i) const { return half_[i]; }
  const Vec3& corner(int i) const { return v_[i]; }

  double lowest(const Vec3& n) const {
    if (triangle_) return std::min(std::min(n.dot(v_[0]), n.dot(v_[1])), n.dot(v_[2]));
    return n.dot(v_[0]) - span(n);
  }
  double highest(const Vec3& n) const {
    if (triangle_) return std::max(std::max(n.dot(v_[0]), n.dot(v_[1])), n.dot(v_[2]));
    return n.dot(v_[0]) + span(n);
  }
  /// Half the width of a box along `n`.
  double span(const Vec3& n) const {
    return half_[0] * std::abs(n.dot(v_[1])) + half_[1] * std::abs(n.dot(v_[2])) + half_[2] * std::abs(n.dot(v_[3]));
  }

 private:
  Hull(bool triangle, const std::array<Vec3, 4>& v, const std::array<double, 3>& half)
      : v_(v), half_(half), triangle_(triangle) {}

  std::array<Vec3, 4> v_;
  std::array<double, 3> half_;
  bool triangle_ = false;
};

/// A piece of A's surface at the two ends of a motion (B's axes, from the origin of B's tree).
struct MovingHull {
  Hull start, end;
  double reach = 0;   ///< largest distance of a point of it from A's center of mass, m
  double radius = 0;  ///< largest distance of a point of it from its middle, m
  double width = 0;   ///< of a box half its second extent, m: a long strip is as good as a short one
};

}  // namespace tegotae
