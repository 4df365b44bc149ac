#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "narrowphase/patch_tree.hpp"

namespace tegotae {

/// Faces of a block of FaceBlocks.
inline constexpr std::uint32_t kBlockFaces = 16;

/// Boxes are grown by this share of the coordinates that they come from, in single precision.
inline constexpr float kBoxError = 1e-6F;

/// A box along the axes of a PatchTree, from its origin, m.
struct AxisBox {
  std::array<float, 3> low, high;

  /// That holds nothing.
  static AxisBox empty();
  /// Made to hold all from `from` to `to`, rounded outwards.
  void add(const Vec3& from, const Vec3& to);
  void add(const AxisBox& other);
  bool overlaps(const AxisBox& other) const {
    const auto along = [&](std::size_t i) { return low[i] <= other.high[i] && other.low[i] <= high[i]; };
    return along(0) && along(1) && along(2);
  }
};

/// Eight boxes, field after field. Places without a box have an empty one, which overlaps nothing.
struct alignas(32) BoxLanes {
  static constexpr std::uint32_t kBoxes = 8;
  std::array<std::array<float, kBoxes>, 3> low, high;
};

/// The faces of a surface in blocks of up to sixteen that lie beside each other and face about the same way, and a
/// hierarchy of upright boxes over the blocks. For questions that are asked once and of all faces: a PatchTree's boxes
/// fit closer and take ten times as long. Immutable; 6 bytes a triangle.
class FaceBlocks {
 public:
  /// Levels of a hierarchy over any number of faces, and nodes that go together.
  static constexpr std::uint32_t kMostLevels = 11, kFan = BoxLanes::kBoxes;

  explicit FaceBlocks(const PatchTree& tree);

  std::uint32_t count() const { return nodes(0); }
  /// Faces of a block, up to kBlockFaces.
  std::uint32_t faces(std::uint32_t block) const { return first_[block + 1] - first_[block]; }
  std::uint32_t face(std::uint32_t block, std::uint32_t k) const { return order_[first_[block] + k]; }
  /// The highest level has one node, level 0 the blocks; node `i` is over those from kFan · i on, one level below.
  std::uint32_t levels() const { return static_cast<std::uint32_t>(levels_.size()); }
  std::uint32_t nodes(std::uint32_t level) const { return levels_[level].nodes; }
  AxisBox box(std::uint32_t level, std::uint32_t node) const;
  /// Those that node `i` of the level above is over.
  const BoxLanes& boxes_below(std::uint32_t level, std::uint32_t i) const { return levels_[level].boxes[i]; }

 private:
  struct Level {
    std::uint32_t nodes;
    std::vector<BoxLanes> boxes;
  };
  static Level level_of(const std::vector<AxisBox>& boxes);

  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> first_;  ///< of each block, in order_; the end after the last
  std::vector<Level> levels_;
};

/// The nodes of one level that meet a box, one by one.
class BlockWalk {
 public:
  static constexpr std::uint32_t kMostTops = 32;
  struct Node {
    std::uint32_t level, index;
  };

  void start(const FaceBlocks& blocks, const AxisBox& box, std::uint32_t level = 0);
  /// Those of them that are under some nodes of a higher level, up to kMostTops. All nodes are told that are of the
  /// same.
  void start_under(const std::uint32_t* nodes, std::uint32_t count, std::uint32_t level_of_nodes,
                   const FaceBlocks& blocks, const AxisBox& box, std::uint32_t level = 0);
  /// Up to `most` more of them to `out`; returns how many. Fewer than asked are the last.
  std::uint32_t next(std::uint32_t* out, std::uint32_t most);

 private:
  const FaceBlocks* blocks_ = nullptr;
  AxisBox box_{};
  std::uint32_t level_ = 0;
  std::array<Node, FaceBlocks::kMostLevels * FaceBlocks::kFan + kMostTops> stack_;
  std::uint32_t stacked_ = 0;
};

}  // namespace tegotae
