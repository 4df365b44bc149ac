#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "narrowphase/face_blocks.hpp"
#include "narrowphase/face_lanes.hpp"

namespace tegotae {

/// A box along the faces that are in it: the last axis across them.
struct Slab {
  Vec3 center;  ///< m, axes of the PatchTree
  Mat3 axes;    ///< of unit length, one a column
  Vec3 half;    ///< m
};

/// A slab at the two ends of a motion, in the axes of what it moves past.
struct MovedSlab {
  Vec3 from, to;            ///< its center, m
  Mat3 from_axes, to_axes;  ///< as long as the slab's halves
  Mat3 axes;                ///< at the start, of unit length

  /// Its corners from `origin` (m): those of one side across come first.
  MovedBox corners(const Vec3& origin) const;
};

/// Eight slabs that go together, field after field, from a point near them. Places without a slab repeat the last one.
struct alignas(64) SlabLanes {
  typedef std::array<float, FaceBlocks::kFan> Field;
  Vec3 origin;                                ///< from that of the tree, m
  float size = 0;                             ///< largest sum of coordinates and halves, m
  alignas(32) std::array<Field, 3> center;    ///< m
  std::array<Field, 3> normal;                ///< the last axis
  Field thickness;                            ///< the half along it, m
  std::array<std::array<Field, 3>, 3> sides;  ///< the axes, as long as the halves, m

  SlabLanes(const Slab* slabs, std::size_t count);

  /// The center of one, from that of the tree.
  Vec3 middle(std::uint32_t k) const { return origin + Vec3(center[0][k], center[1][k], center[2][k]); }
  /// Of a ball about it that holds the slab, m.
  double radius(std::uint32_t k) const noexcept;
};

/// The slabs of the lowest levels of FaceBlocks: they tell whole blocks of surfaces that face each other apart, up to
/// the depth of what curves within a block. Immutable; 15 bytes a triangle.
class BlockSlabs {
 public:
  /// Levels at most: beyond, they are hardly flatter than boxes.
  static constexpr std::uint32_t kLevels = 3;

  BlockSlabs(const PatchTree& tree, const FaceBlocks& blocks);

  std::uint32_t levels() const { return static_cast<std::uint32_t>(slabs_.size()); }
  /// Centers are from the tree's origin.
  const Slab& slab(std::uint32_t level, std::uint32_t node) const { return slabs_[level][node]; }
  /// The one of node FaceBlocks::kFan · i and those after it.
  const SlabLanes& lanes(std::uint32_t level, std::uint32_t i) const { return lanes_[level][i]; }
  /// Calls for those slabs.
  void call_for(std::uint32_t level, std::uint32_t i) const noexcept {
    const std::size_t first = std::size_t{FaceBlocks::kFan} * i, count = slabs_[level].size() - first;
    prefetch(&slabs_[level][first], std::min<std::size_t>(count, FaceBlocks::kFan) * sizeof(Slab));
  }

 private:
  std::vector<std::vector<Slab>> slabs_;       ///< of each level
  std::vector<std::vector<SlabLanes>> lanes_;  ///< likewise
};

/// A slab at the two ends of a motion in single precision, from a point near it, in the axes of what it moves past.
struct SlabEnds {
  std::array<std::array<float, 3>, 2> center;                ///< m
  std::array<std::array<std::array<float, 3>, 3>, 2> sides;  ///< its axes, as long as its halves, m
  std::array<float, 3> normal;                               ///< the last axis at the start
  float size;                                                ///< largest sum of all these coordinates, m

  SlabEnds() = default;
  explicit SlabEnds(const MovedSlab& a, const Vec3& origin);
};

/// Eight slabs of A at the two ends of a motion, field after field, from a point near them.
struct alignas(64) MovedSlabs {
  typedef SlabLanes::Field Field;
  Vec3 origin;  ///< m
  alignas(32) std::array<std::array<Field, 3>, 2> center;
  std::array<std::array<std::array<Field, 3>, 3>, 2> sides;
  std::array<Field, 3> normal;
  std::array<Field, 3> low, high;  ///< of all that they pass, from the point, m
  Field size;                      ///< as that of SlabEnds

  /// `start` and `end` bring A's slabs, from the origin of its tree, to where they are.
  void set(const SlabLanes& a, const Placement& start, const Placement& end) noexcept;
  SlabEnds slab(std::uint32_t k) const noexcept;
  /// About all that slab `k` passes, and `slack` (m) around it.
  AxisBox box(std::uint32_t k, double slack) const noexcept;
};

/// The share of a straight motion, from its start, in which a fixed plane along a side of a slab keeps `a` at
/// least `floor` (m) apart from `b`; 0 where none does at the start.
double apart_for(const MovedSlab& a, const Slab& b, double floor) noexcept;

/// Of eight slabs, those that planes across A's faces or across theirs keep at least `floor` apart from `a`, whose
/// point is `origin`, all along the motion: a bit each. The rounding in single precision is taken off.
std::uint32_t kept_apart(const SlabEnds& a, const Vec3& origin, const SlabLanes& b, double floor) noexcept;

/// Of the nodes under some of B's, those that meet `box` and that planes do not keep apart from `a` in this way: up to
/// `most` of them to `out`. Returns how many, or more than `most` if there are more.
std::uint32_t not_kept_apart_under(const std::uint32_t* nodes, std::uint32_t count, std::uint32_t level_of_nodes,
                                   const FaceBlocks& blocks, const BlockSlabs& slabs, const SlabEnds& a,
                                   const Vec3& origin, const AxisBox& box, double floor, std::uint32_t* out,
                                   std::uint32_t most) noexcept;

}  // namespace tegotae
