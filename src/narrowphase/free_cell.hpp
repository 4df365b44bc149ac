#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "narrowphase/moving_plane.hpp"
#include "narrowphase/patch_separate.hpp"

namespace tegotae {

/// Most planes of a free cell.
inline constexpr int kCellPlanes = 16;

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

/// Where a piece of A's surface may be without meeting B: above every plane, n · x >= offset, which has all of B that
/// it stands for below it. Normals (B's axes) are of unit length up to single precision, offsets rounded up. What of B
/// no plane stands for is at least `clear` (m) from the piece as it was when the cell was found.
struct FreeCell {
  std::array<float, kCellPlanes> nx, ny, nz, offset;  ///< of planes that are not there everything is above
  double clear = 0;

  FreeCell() { drop_planes(); }
  void drop_planes() {
    nx.fill(0);
    ny.fill(0);
    nz.fill(0);
    offset.fill(std::numeric_limits<float>::lowest());
  }
  Vec3 normal(int k) const { return {double{nx[k]}, double{ny[k]}, double{nz[k]}}; }
};

/// Most pieces of B that a cell's list has room for.
inline constexpr int kCellItems = 31;

/// The pieces of B that are near a piece of A: nodes of B's tree or, with the highest bit set, faces.
struct CellItems {
  static constexpr std::uint32_t kFace = 0x80000000u;
  double clear = 0;         ///< the rest of B is at least so far (m) from the piece as it was at the search
  std::uint32_t count = 0;  ///< 0: not known, or more than fit
  std::array<std::uint32_t, kCellItems> item;
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

/// What a free cell says of a motion.
struct CellVerdict {
  bool free = false;  ///< the planes keep their sides during the whole motion
  double margin = 0;  ///< least distance from the piece at the start to what the planes stand for, m
  double share = 0;   ///< part of the motion, in [0, 1], during which the planes keep their sides
};

/// Whether the planes of `cell` stay below `a` during the motion.
CellVerdict check_cell(const FreeCell& cell, const MovingHull& a, const Sweep& sweep) noexcept;

/// Looks for free cells between pieces of A and subtrees of B.
class CellSearch {
 public:
  enum class Outcome : std::uint8_t {
    found,    ///< for the whole motion
    passing,  ///< the motion is free, but no cell says so: to be searched again for the next one
    divide,   ///< not as a whole: the piece of A or the subtree of B is to be taken apart
    blocked   ///< triangles of B, listed, stop the piece, which is a triangle
  };
  struct Query {
    const PatchTree* tree = nullptr;  ///< of B
    std::uint32_t node = 0;           ///< of `tree`, or face
    bool is_face = false;
    double need = 0;                   ///< what is farther from the piece (m) does not matter to the motion
    double wanted = 0;                 ///< what is farther (m) needs no plane; at least `need`
    const CellItems* known = nullptr;  ///< all of B that is nearer to the piece than `clear` (m); null: look at all
    double clear = 0;
  };

  CellSearch();

  /// Looks for a cell of `a` (`face_of_a`: its corners, A's axes from the center of mass, when it is a triangle)
  /// against the subtree. `cell` is set when found; its margin at the start is margin(), its pieces of B items().
  Outcome find(const MovingHull& a, const std::array<Vec3, 3>* face_of_a, const Query& query, const Sweep& sweep,
               FreeCell& cell) noexcept;

  /// Of the last find(): least distance of the piece at the start from B that was proved, m.
  double margin() const { return std::min(margin_, clear_); }
  /// Of the last find() that found a cell: what its planes stand for. Of one that says to divide: where to go on with
  /// the parts.
  const CellItems& items() const { return items_; }
  /// Of the last find(): faces of B that stop the triangle.
  const std::vector<std::uint32_t>& blocking() const { return blocking_; }
  /// Nodes and faces of B visited by all calls.
  std::int64_t visits() const { return visits_; }

 private:
  struct Entry {
    std::uint32_t node;
    bool is_face;
    double distance;  ///< lower bound at the start; of a face that of its leaf
  };

  Outcome settle(const Entry& e);
  Outcome settle_face(const Entry& e, const Hull& b, const Vec3& best);
  void open(const Entry& e);
  Entry entry(std::uint32_t node) const;
  Hull hull_of(const Entry& e) const;
  bool under_known_plane(const Hull& b, double good);
  /// The normal of a face of either box or triangle along which `b` is farthest below the piece at the start.
  double best_axis(const Hull& b, Vec3& n) const;
  void begin(const Query& query);
  void list_rest(const Entry& e);
  void list(const Entry& e);
  bool stays_above(const Vec3& n, double low_start, double low_end, double top) const;
  bool keeps_off(const Hull& b, const Vec3& n, double at_least);
  bool best_of_all_axes(const Hull& b, Vec3& n) const;

  const MovingHull* a_ = nullptr;
  const std::array<Vec3, 3>* face_of_a_ = nullptr;
  const Sweep* sweep_ = nullptr;
  Query query_;
  Vec3 middle_;
  Vec3 normal_of_a_;  ///< of a triangle, unit or zero
  int planes_ = 0;
  std::array<Vec3, kCellPlanes> normal_;
  std::array<double, kCellPlanes> low_start_, low_end_, top_;
  double margin_ = 0, clear_ = 0;
  CellItems items_;
  bool listed_ = true;  ///< items_ has them all
  bool passing_ = false;
  bool full_ = false;  ///< a plane more was needed than a cell has
  std::vector<Entry> stack_;
  std::vector<std::uint32_t> blocking_;
  std::int64_t visits_ = 0;
};

}  // namespace tegotae
