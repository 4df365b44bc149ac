#pragma once

#include "narrowphase/facing.hpp"
#include "narrowphase/patch_separate.hpp"

namespace tegotae {

/// What the faces of one part see of a motion: the velocity of the other part's points, in the faces' own frame. A face
/// that bounds a solid and recedes from all that is near it cannot be what two parts that are apart touch with first.
class PassingPoints {
 public:
  static PassingPoints seen_from_a(const Sweep& sweep);
  static PassingPoints seen_from_b(const Sweep& sweep);

  /// Whether all faces under the cone recede from all points within `radius` of `at`, during the whole motion and with
  /// that during each first part of it. `at` is from A's center of mass at the start, in the faces' frame.
  bool recedes(const NormalCone& cone, const Vec3& at, double radius) const;
  /// Whether all faces under the cone approach what is at `at`: it is not worth asking of each whether it recedes.
  bool meets(const NormalCone& cone, const Vec3& at) const;

 private:
  Vec3 dp_ = Vec3::Zero(), dr_ = Vec3::Zero();
  double sign_ = 1;      ///< of the velocity as the face sees it
  double center_ = 0;    ///< how far the velocity of the center of mass is off `dp` at most, m
  double distance_ = 0;  ///< from which the other part's points count as near, m
};

}  // namespace tegotae
