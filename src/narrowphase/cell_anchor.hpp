#pragma once

#include <array>

#include "narrowphase/free_cell.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae {

/// A motion of A in the world, for anchors.
struct AnchoredMotion {
  AnchoredMotion() = default;
  /// Of A from `X` by `d` of its center of mass `center` (m, file frame), after it turned by `turned` (rad, all its
  /// turns added up).
  AnchoredMotion(const Pose& X, const Displacement& d, const Vec3& center, double turned);

  Mat3 R_start, R_end;
  Vec3 p_start, p_end;          ///< center of mass
  double turn_start, turn_end;  ///< rad
  double bulge;                 ///< θ²/8, rounded up
  double center_distance;       ///< from the file frame's origin to the center of mass, m
};

/// Where a piece of A was when its distances from the planes of its free cell were last known. Each plane loses what
/// the piece has come against it since, and nothing where it went away from it or along it.
struct CellAnchor {
  CellAnchor();
  /// Of a piece at the start of the motion: its `middle` (A's axes, from the center of mass, m) and `radius` about it
  /// (m), and its `gaps` to the planes.
  CellAnchor(const CellGaps& gaps, const Vec3& middle, double radius, const AnchoredMotion& motion);

  std::array<float, kCellPlanes> gap;  ///< along the planes' normals, m; negative infinity: not known
  std::array<double, 3> x;             ///< of `point`, world, m
  double turn;                         ///< turns of A added up, rad
  std::array<float, 3> point;          ///< near the middle of the piece, A's axes from the center of mass, m
  float radius;                        ///< largest distance of a point of the piece from `point`, m
};

/// Least gaps along the normals of the planes, at least, at the two ends of a motion, m; between them they are not less
/// than on the straight line from one to the other, but for `bulge` (m).
struct AnchoredGap {
  double start, end, bulge;
};

/// `R_WB` turns the cell into the world.
AnchoredGap anchored_gap(const FreeCell& cell, const CellAnchor& anchor, const Mat3& R_WB,
                         const AnchoredMotion& motion) noexcept;

}  // namespace tegotae
