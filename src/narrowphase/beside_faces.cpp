#include "narrowphase/beside_faces.hpp"

#include <algorithm>
#include <cmath>

#include "narrowphase/face_gaps.hpp"

namespace tegotae {
namespace {

/// Blocks that are called for before they are read.
constexpr std::uint32_t kAhead = 3;

/// Those of eight faces of `a` that the mean normal of `b` keeps less than `floor` apart from all of it.
TEGOTAE_INLINE LaneBits near_all(const MovedLanes& a, std::uint32_t first, const FaceLanes& b, float up, float floor) {
  Lane low = dot(load3(a.corner[0], first), b.mean), high = low;
  for (std::size_t c = 1; c < 6; ++c) {
    const Lane x = dot(load3(a.corner[c], first), b.mean);
    low = lesser(low, x);
    high = greater(high, x);
  }
  return (LaneBits)(greater(low + (up - b.mean_high), (b.mean_low - up) - high) < floor);
}

/// Those of eight faces of `b` that the mean normal of `a` keeps less than `floor` apart from all of it.
TEGOTAE_INLINE LaneBits all_near(const MovedLanes& a, const FaceLanes& b, std::uint32_t first, float up, float floor) {
  const Lane p = dot(load3(b.corner[0], first), a.mean), q = dot(load3(b.corner[1], first), a.mean),
             r = dot(load3(b.corner[2], first), a.mean);
  return (LaneBits)(greater((a.mean_low + up) - greater(greater(p, q), r),
                            lesser(lesser(p, q), r) - (a.mean_high + up)) < floor);
}

/// A bit for each face of `a` that may be nearer than `floor` to one of `b`, by what is known of all faces together.
TEGOTAE_WIDE std::uint32_t not_kept_apart_together(const MovedLanes& a, const FaceLanes& b, const Float3& shift,
                                                   float floor) {
  float up = dot(a.mean, shift);
  if (together(all_near(a, b, 0, up, floor) | all_near(a, b, kLane, up, floor)) == 0) return 0;
  up = dot(b.mean, shift);
  return bits_of(near_all(a, 0, b, up, floor), near_all(a, kLane, b, up, floor));
}

/// Goes on to the next of the blocks in `open` of which something is not kept apart; `open` then holds those after it.
TEGOTAE_WIDE std::uint32_t next_below(const OneFace& a, const Float3& direction, const BoxLanes* boxes,
                                      const BesideFaces::Block* blocks, std::uint32_t& open, std::uint32_t& at) {
  const AxisBox box = {{a.low(0), a.low(1), a.low(2)}, {a.high(0), a.high(1), a.high(2)}};
  const Along guess = along(direction, a);
  while (open != 0) {
    const std::uint32_t group = static_cast<std::uint32_t>(__builtin_ctz(open)) / BoxLanes::kBoxes;
    const std::uint32_t of_group = 0xFFU << (BoxLanes::kBoxes * group);
    std::uint32_t near = open & of_group & (overlap(boxes[group], box) << (BoxLanes::kBoxes * group));
    for (; near != 0; near &= near - 1) {
      at = static_cast<std::uint32_t>(__builtin_ctz(near));
      const std::uint32_t faces = gaps_below(a, guess, *blocks[at].faces, blocks[at].shift, blocks[at].floor);
      if (faces == 0) continue;
      open &= ~(of_group | ((1U << at) - 1)) | (near & (near - 1));
      return faces;
    }
    open &= ~of_group;
  }
  return 0;
}

}  // namespace

void BesideFaces::set(const FaceBlocks& blocks, const std::vector<FaceLanes>& lanes, const std::uint32_t* found,
                      std::uint32_t count, const MovedLanes& a, const Vec3& origin, double floor) noexcept {
  open_.fill(0);
  const Float3 at = in_single(origin);
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < std::min(count, kAhead); ++i) lanes[found[i]].call_for();
  for (std::uint32_t i = 0; i < count; ++i) {
    if (i + kAhead < count) lanes[found[i + kAhead]].call_for();
    const FaceLanes& faces = lanes[found[i]];
    const Vec3 shift = origin - faces.origin;
    const Block block = {&faces, in_single(shift), floor_in_single(a.size, faces, shift, floor), found[i]};
    std::uint32_t open = not_kept_apart_together(a, faces, block.shift, block.floor);
    if (open == 0) continue;
    for (; open != 0; open &= open - 1) open_[static_cast<std::size_t>(__builtin_ctz(open))] |= 1U << kept;
    blocks_[kept] = block;
    const AxisBox box = blocks.box(0, found[i]);
    BoxLanes& out = boxes_[kept / BoxLanes::kBoxes];
    for (std::size_t c = 0; c < 3; ++c) {
      const float slack =
          static_cast<float>(floor) + kBoxError * (std::abs(at[c]) + std::abs(box.low[c]) + std::abs(box.high[c]));
      out.low[c][kept % BoxLanes::kBoxes] = box.low[c] - at[c] - slack;
      out.high[c][kept % BoxLanes::kBoxes] = box.high[c] - at[c] + slack;
    }
    ++kept;
  }
}

std::uint32_t BesideFaces::next_not_kept_apart(const MovedLanes& a, std::uint32_t k, const Float3& guess,
                                               std::uint32_t& open, std::uint32_t& at) const noexcept {
  return open == 0 ? 0 : next_below(OneFace{a, k}, guess, boxes_.data(), blocks_.data(), open, at);
}

}  // namespace tegotae
