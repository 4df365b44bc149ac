#pragma once

#include <array>

#include "curve/axis_search.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae {

/// A frame whose z axis is a screw axis, with the rise of the motion about it.
struct ScrewFrame {
  Mat3 R = Mat3::Identity();   ///< from the frame to the file frame; its columns are x, y and the axis
  Vec3 origin = Vec3::Zero();  ///< m, file frame
  double rise = 0;             ///< m/rad

  /// The frame of `axis` with another rise: its own, or the one of the part that it shall meet.
  static ScrewFrame of(const ScrewAxis& axis, double rise);
  Vec3 local(const Vec3& p) const { return R.transpose() * (p - origin); }
};

/// Directions (cos, sin) of k · 15°, k = 0 … 11, in the profile plane.
inline constexpr int kProfileDirections = 12;
struct ProfileDirections {
  std::array<double, kProfileDirections> c, s;
};
const ProfileDirections& profile_directions();

/// What a piece of surface covers in the coordinates of a ScrewFrame: with r, φ, z the cylindrical coordinates of a
/// point and w = z − rise · φ, each point of the piece has an angle φ (of all that differ by turns) for which
///     lo[k] ≤ c[k] r + s[k] w ≤ hi[k]  for all k.
/// A screw motion of that rise leaves r and w as they are. Lengths in m, angles in rad.
template <typename Real>
struct ProfileBounds {
  std::array<Real, kProfileDirections> lo, hi;
  Real r_lo, r_hi;  ///< r_lo = 0: the piece may meet the axis, and nothing else holds
  Real z_lo, z_hi;
  Real azimuth, half;  ///< φ of all points is within `half` of `azimuth`, up to turns; half ≥ π: anywhere

  bool usable() const { return r_lo > 0; }
};
using ProfileSum = ProfileBounds<double>;  ///< while it is built
using ProfileBox = ProfileBounds<float>;   ///< as it is stored: rounded outward

/// Bounds of a triangle with corners `v` in the frame's coordinates. Triangles that reach the axis are not usable.
ProfileSum profile_of(const std::array<Vec3, 3>& v, double rise);
/// Bounds of two pieces together.
ProfileSum joined(const ProfileSum& a, const ProfileSum& b, double rise);
ProfileBox rounded(const ProfileSum& p, double rise);
/// The same piece in the frame turned by half a turn about its x axis.
ProfileBox flipped(const ProfileBox& p);

}  // namespace tegotae
