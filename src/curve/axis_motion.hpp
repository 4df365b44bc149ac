#pragma once

#include "curve/profile_box.hpp"

namespace tegotae {

/// Where A's axis is in B's screw frame, taken apart: a point of A with cylindrical coordinates (r, φ, z) about its own
/// axis first turns by psi, then tilts with the axis (by the shortest turn), then moves by the offset.
struct AxisPose {
  double offset_x = 0, offset_y = 0;  ///< m
  double lean_x = 0, lean_y = 0;      ///< horizontal part of A's axis, a unit vector
  double lean = 0, lean2 = 0;         ///< its length; lean² / (1 + cosine of the tilt)
  double cos_psi = 1, sin_psi = 0;
  double psi = 0;    ///< rad, some turns added or not
  double shift = 0;  ///< along B's axis less rise · psi, m

  /// `R`, `t` of A's frame in B's. Of all psi the one next to `near_psi`.
  static AxisPose of(const Mat3& R, const Vec3& t, double rise, double near_psi);
};

/// A motion of A's axis past B's with all that a curved certificate takes off
/// (docs/decisions/0077-curved-certificate.md): lengths in m, angles in rad. For every point of A and both readings of
/// its path,
///     |d²r/ds²| ≤ acceleration + speed² / r,   |d²φ/ds²| ≤ the same / r,   |d²z/ds²| ≤ vertical,   |dr/ds| ≤ speed.
struct AxisMotion {
  AxisPose start, end;
  double rise = 0;
  double speed = 0, acceleration = 0, vertical = 0;
  double start_floor = 0, floor = 0;  ///< gaps below do not count, with the rounding of one gap
  bool usable = false;                ///< the axes are near enough to each other and the turn is small enough
};

/// A rigid motion of A's frame in B's screw frame, by the two placements at its ends. A point that moves linearly is
/// known by where it is at both.
struct FrameMotion {
  Mat3 R0, R1;                                ///< A's screw frame in B's at the start and at the end
  Vec3 t0, t1;                                ///< its origin, m
  Vec3 turn;                                  ///< rotation vector of the motion in B's frame, rad
  Vec3 center0, center1;                      ///< A's center of mass, m
  Vec3 origin0, origin1;                      ///< A's file origin, m
  double reach_center = 0, reach_origin = 0;  ///< largest distance of a point of A from them, m
  double size = 0;                            ///< of the scene: bounds all coordinates, m
};

/// Floors: see Sweep. `near_psi` as in AxisPose.
AxisMotion axis_motion(const FrameMotion& m, double rise, double start_floor, double floor, double near_psi);

}  // namespace tegotae
