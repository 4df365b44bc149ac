#pragma once

#include <array>

#include "narrowphase/free_cell.hpp"

namespace tegotae {

/// Where a piece of A was when its distances from the planes of its free cell were last known. Each plane loses what
/// the piece has come against it since, and nothing where it went away from it or along it.
struct CellAnchor {
  CellAnchor();
  /// Of a piece at the start of the motion: its `middle` (A's axes, from the center of mass, m) and `radius` about it
  /// (m), and its `gaps` to the planes. A has `turned` (rad) so far, all its turns added up.
  CellAnchor(const CellGaps& gaps, const Vec3& middle, double radius, const Sweep& sweep, double turned);

  std::array<float, kCellPlanes> gap;  ///< along the planes' normals, m; negative infinity: not known
  std::array<double, 3> x;             ///< of `point`, in B as in a Sweep, m
  double turn;                         ///< turns of A added up, rad
  std::array<double, 3> point;         ///< middle of the piece, A's axes from the center of mass, m
  double radius;                       ///< largest distance of a point of the piece from `point`, m
};

/// Where a piece of A was when its distance from what no plane of its cell stands for was known last, and how far it
/// was taken to be shifted from there: the distance is that of all that the piece covers on the way.
struct CellCorridor {
  CellCorridor() = default;
  /// Of a piece at the start of the motion and its shift `ahead` (m, B's axes); `middle`, `radius` and `turned` as
  /// those of an anchor.
  CellCorridor(const Vec3& middle, double radius, const Vec3& ahead, const Sweep& sweep, double turned);

  std::array<double, 3> x{};      ///< of `point`, in B as in a Sweep, m
  std::array<double, 3> ahead{};  ///< m, B's axes
  std::array<double, 3> point{};  ///< middle of the piece, A's axes from the center of mass, m
  double turn = 0;                ///< turns of A added up, rad
  double radius = 0;              ///< largest distance of a point of the piece from `point`, m
};

/// How far a piece, or a part of it, is at most from its corridor at the two ends of a motion, m; between them it is
/// not farther than on the straight line from one to the other, but for `bulge` (m).
struct CorridorLoss {
  double start, end, bulge;
};

CorridorLoss corridor_loss(const CellCorridor& corridor, const Sweep& sweep, double turned) noexcept;

/// Least gaps along the normals of the planes, at least, at the two ends of a motion, m; between them they are not less
/// than on the straight line from one to the other, but for `bulge` (m).
struct AnchoredGap {
  double start, end, bulge;
};

AnchoredGap anchored_gap(const FreeCell& cell, const CellAnchor& anchor, const Sweep& sweep, double turned) noexcept;

}  // namespace tegotae
