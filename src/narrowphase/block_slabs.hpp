#pragma once

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

/// The slabs of the lowest levels of FaceBlocks: they tell whole blocks of surfaces that face each other apart, up to
/// the depth of what curves within a block. Immutable; 9 bytes a triangle.
class BlockSlabs {
 public:
  /// Levels at most: beyond, they are hardly flatter than boxes.
  static constexpr std::uint32_t kLevels = 3;

  BlockSlabs(const PatchTree& tree, const FaceBlocks& blocks);

  std::uint32_t levels() const { return static_cast<std::uint32_t>(slabs_.size()); }
  /// Centers are from the tree's origin.
  const Slab& slab(std::uint32_t level, std::uint32_t node) const { return slabs_[level][node]; }

 private:
  std::vector<std::vector<Slab>> slabs_;  ///< of each level
};

/// The share of a straight motion, from its start, in which a fixed plane along a side of a slab keeps `a` at
/// least `floor` (m) apart from `b`; 0 where none does at the start.
double apart_for(const MovedSlab& a, const Slab& b, double floor) noexcept;

}  // namespace tegotae
