#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "narrowphase/patch_tree.hpp"

namespace tegotae {

/// Faces of a block of FaceBlocks.
inline constexpr std::uint32_t kBlockFaces = 16;

/// A box along the axes of a PatchTree, from its origin, m.
struct AxisBox {
  std::array<float, 3> low, high;

  /// That holds nothing.
  static AxisBox empty();
  /// Made to hold all from `from` to `to`, rounded outwards.
  void add(const Vec3& from, const Vec3& to);
  void add(const AxisBox& other);
  bool overlaps(const AxisBox& other) const {
    return (low[0] <= other.high[0]) & (other.low[0] <= high[0]) & (low[1] <= other.high[1]) &
           (other.low[1] <= high[1]) & (low[2] <= other.high[2]) & (other.low[2] <= high[2]);
  }
};

/// The faces of a surface in blocks of sixteen that lie beside each other, and a hierarchy of upright boxes over the
/// blocks. For questions that are asked once and of all faces: a PatchTree's boxes fit closer and take ten times as
/// long. Immutable; 6 bytes a triangle.
class FaceBlocks {
 public:
  /// Levels of a hierarchy over any number of faces, and nodes that go together.
  static constexpr std::uint32_t kMostLevels = 11, kFan = 8;

  explicit FaceBlocks(const PatchTree& tree);

  std::uint32_t count() const { return static_cast<std::uint32_t>(boxes_[0].size()); }
  /// Faces of a block: fewer than kBlockFaces in the last one alone.
  std::uint32_t faces(std::uint32_t block) const;
  std::uint32_t face(std::uint32_t block, std::uint32_t k) const { return order_[block * kBlockFaces + k]; }
  /// The highest level has one node, level 0 the blocks; node `i` is over those from kFan · i on, one level below.
  std::uint32_t levels() const { return static_cast<std::uint32_t>(boxes_.size()); }
  const std::vector<AxisBox>& boxes(std::uint32_t level) const { return boxes_[level]; }

 private:
  std::vector<std::uint32_t> order_;
  std::vector<std::vector<AxisBox>> boxes_;  ///< of each level
};

/// The blocks that meet a box, one by one.
class BlockWalk {
 public:
  void start(const FaceBlocks& blocks, const AxisBox& box);
  /// Up to `most` more of them to `out`; returns how many. Fewer than asked are the last.
  std::uint32_t next(std::uint32_t* out, std::uint32_t most);

 private:
  struct Node {
    std::uint32_t level, index;
  };
  const FaceBlocks* blocks_ = nullptr;
  AxisBox box_{};
  std::array<Node, FaceBlocks::kMostLevels * FaceBlocks::kFan> stack_;
  std::uint32_t stacked_ = 0;
};

}  // namespace tegotae
