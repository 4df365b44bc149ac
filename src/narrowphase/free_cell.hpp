#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "narrowphase/hull.hpp"
#include "narrowphase/moving_plane.hpp"
#include "narrowphase/patch_separate.hpp"

namespace tegotae {

/// Most planes of a free cell.
inline constexpr int kCellPlanes = 16;

/// Where a piece of A's surface may be without meeting B: above every plane, n · x >= offset, which has all of B that
/// it stands for below it. Normals (B's axes) are of unit length up to single precision, offsets rounded up. What of B
/// no plane stands for is at least `clear` (m) from the piece as it was when the cell was found.
struct FreeCell {
  std::array<float, kCellPlanes> nx, ny, nz, offset;  ///< of planes that are not there everything is above
  double clear = 0;

  FreeCell() { drop_planes(); }
  /// A cell that says nothing.
  static FreeCell unknown() {
    FreeCell cell;
    cell.clear = -std::numeric_limits<double>::infinity();
    return cell;
  }
  void drop_planes() {
    nx.fill(0);
    ny.fill(0);
    nz.fill(0);
    offset.fill(std::numeric_limits<float>::lowest());
  }
  Vec3 normal(int k) const { return {double{nx[k]}, double{ny[k]}, double{nz[k]}}; }
};

/// `v` as it is after it was kept in single precision. Written so that no compiler leaves the rounding out: GCC 12
/// folds pairs of conversions of neighboring numbers away when it vectorizes them.
inline Vec3 single(const Vec3& v) {
  const volatile float x = static_cast<float>(v.x()), y = static_cast<float>(v.y()), z = static_cast<float>(v.z());
  return {double{x}, double{y}, double{z}};
}

/// Most pieces of B that a cell's list has room for.
inline constexpr int kCellItems = 47;

/// The pieces of B that are nearest to a piece of A: nodes of B's tree or, with the highest bit set, faces.
struct CellItems {
  static constexpr std::uint32_t kFace = 0x80000000u;
  double clear = 0;         ///< the rest of B is at least so far (m) from the piece as it was at the search
  std::uint32_t count = 0;  ///< 0: not known
  std::uint32_t near = 0;   ///< the first so many are under planes of the cell that was found
  std::array<std::uint32_t, kCellItems> item;
  std::array<float, kCellItems> distance;  ///< at least, at the search, m
};

/// How far the arcs of a motion reach past their chords along `n`, for points up to `reach` (m) from the center of
/// mass; see Bulge.
inline double bulge_along(const Vec3& n, double reach, const Sweep& sweep) {
  if (!(sweep.theta2 > 0)) return 0;
  return 0.125 * kUnitSlack * sweep.theta2 * (reach + sweep.center_distance) * sweep.axis.cross(n).norm();
}

/// Whether a gap stays positive: `alpha` and `beta` at the ends of a chord whose arc takes 4 b s (1 − s) off.
inline bool stays_positive(double alpha, double beta, double b) {
  if (!(alpha >= 0 && beta >= 0)) return false;
  return std::min(alpha, beta) >= b || 0.5 * (alpha + beta) - 2 * b + std::sqrt(alpha * beta) >= 0;
}

/// The part of a motion during which a gap stays positive that is `alpha` > 0 at its start and `beta` at its end, and
/// whose arc takes 4 b s (1 − s) off: up to s it is at least alpha + s (beta − alpha) − 4 b s, and the shorter motion's
/// reading with a linear file frame leaves its own arc by at most b s² more.
inline double share_of(double alpha, double beta, double b) {
  const double used = alpha - beta + 5 * b;
  return used > alpha ? alpha / used : 1;
}

/// From a piece of A to each plane of a cell, m; very large for planes that are not there.
using CellGaps = std::array<double, kCellPlanes>;

/// What a free cell says of a motion.
struct CellVerdict {
  bool free = false;  ///< the planes keep their sides during the whole motion
  double margin = 0;  ///< least distance from the piece at the start to what the planes stand for, m
  double share = 0;   ///< part of the motion, in [0, 1], during which the planes keep their sides
  CellGaps gaps;      ///< at the start
};

/// Whether the planes of `cell` stay below `a` during the motion.
CellVerdict check_cell(const FreeCell& cell, const MovingHull& a, const Sweep& sweep) noexcept;

}  // namespace tegotae
