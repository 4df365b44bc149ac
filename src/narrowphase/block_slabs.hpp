#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "narrowphase/face_blocks.hpp"
#include "narrowphase/face_lanes.hpp"
#include "narrowphase/quadric.hpp"
#include "narrowphase/slab.hpp"

namespace tegotae {

/// The slabs of the lowest levels of FaceBlocks: they tell whole blocks of surfaces that face each other apart, up to
/// the depth of what curves within a block, and their quadrics, which tell more. Immutable; 19 bytes a triangle.
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
  const QuadricLanes& quadrics(std::uint32_t level, std::uint32_t i) const { return quadrics_[level][i]; }
  /// Calls for those slabs.
  void call_for(std::uint32_t level, std::uint32_t i) const noexcept {
    const std::size_t first = std::size_t{FaceBlocks::kFan} * i, count = slabs_[level].size() - first;
    prefetch(&slabs_[level][first], std::min<std::size_t>(count, FaceBlocks::kFan) * sizeof(Slab));
  }

 private:
  std::vector<std::vector<Slab>> slabs_;       ///< of each level
  std::vector<std::vector<SlabLanes>> lanes_;  ///< likewise
  std::vector<std::vector<QuadricLanes>> quadrics_;
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
