#pragma once

#include <array>
#include <cstdint>

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

/// A slab at the two ends of a motion in single precision, from a point near it, in the axes of what it moves past.
struct SlabEnds {
  std::array<std::array<float, 3>, 2> center;                ///< m
  std::array<std::array<std::array<float, 3>, 3>, 2> sides;  ///< its axes, as long as its halves, m
  std::array<float, 3> normal;                               ///< the last axis at the start
  float size;                                                ///< largest sum of all these coordinates, m

  SlabEnds() = default;
  explicit SlabEnds(const MovedSlab& a, const Vec3& origin);
};

/// The share of a straight motion, from its start, in which a fixed plane along a side of a slab keeps `a` at
/// least `floor` (m) apart from `b`; 0 where none does at the start.
double apart_for(const MovedSlab& a, const Slab& b, double floor) noexcept;

}  // namespace tegotae
