#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "narrowphase/face_lanes.hpp"

namespace tegotae {

/// Blocks of B's faces beside a block of A's, as its faces are asked about them one by one.
class BesideFaces {
 public:
  static constexpr std::uint32_t kMost = 32;
  struct Block {
    const FaceLanes* faces;
    std::array<float, 3> shift;  ///< the origin of A's faces from theirs, m
    float floor;                 ///< m, with room for the rounding of all that is asked about
    std::uint32_t index;         ///< of B's blocks
  };

  /// The blocks `found` of B beside `a`, whose common point is `origin` from that of B's tree.
  void set(const FaceBlocks& blocks, const std::vector<FaceLanes>& lanes, const std::uint32_t* found,
           std::uint32_t count, const MovedLanes& a, const Vec3& origin, double floor) noexcept;
  /// Those from which face `k` of A's is not kept apart as a whole: a bit each.
  std::uint32_t open(std::uint32_t k) const { return open_[k]; }
  /// Which of B's blocks the one of a bit is.
  std::uint32_t index(std::uint32_t bit) const { return blocks_[bit].index; }
  /// Of the blocks in `open`, the first of which not all faces are kept apart from face `k` of `a` as by
  /// not_kept_apart() or by a direction that is likely to, of no more than unit length: a bit for each of them, that of
  /// the block to `bit`, and the blocks that come after it to `open`. None: all are.
  std::uint32_t next_not_kept_apart(const MovedLanes& a, std::uint32_t k, const std::array<float, 3>& guess,
                                    std::uint32_t& open, std::uint32_t& bit) const noexcept;

 private:
  std::array<BoxLanes, kMost / BoxLanes::kBoxes> boxes_{};  ///< grown by what is to be kept
  std::array<Block, kMost> blocks_;
  std::array<std::uint32_t, kBlockFaces> open_{};
};

}  // namespace tegotae
