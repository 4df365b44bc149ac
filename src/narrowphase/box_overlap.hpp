#pragma once

#include <array>
#include <cstdint>
#include <cstring>

#include "narrowphase/face_blocks.hpp"
#include "narrowphase/wide.hpp"

namespace tegotae {

/// Eight numbers, bit by bit.
typedef std::int32_t EightBits __attribute__((vector_size(8 * sizeof(std::int32_t)), may_alias));

/// One bit in each of eight numbers, the first in the first.
inline constexpr EightBits kEachBit = {1, 2, 4, 8, 16, 32, 64, 128};

/// All bits of eight numbers in one.
TEGOTAE_INLINE std::uint32_t together(const EightBits& bits) {
  std::array<std::uint64_t, 4> in_pairs;
  std::memcpy(in_pairs.data(), &bits, sizeof bits);
  const std::uint64_t pair = in_pairs[0] | in_pairs[1] | in_pairs[2] | in_pairs[3];
  return static_cast<std::uint32_t>(pair | pair >> 32);
}

/// Those of the boxes that overlap `box`, a bit each: to be compiled into what is compiled for several widths of
/// registers itself.
TEGOTAE_INLINE std::uint32_t overlap(const BoxLanes& boxes, const AxisBox& box) {
  typedef float Lane __attribute__((vector_size(BoxLanes::kBoxes * sizeof(float)), may_alias));
  static_assert(sizeof(Lane) == sizeof(EightBits));
  EightBits all = kEachBit;
  for (std::size_t i = 0; i < 3; ++i) {
    const Lane low = *reinterpret_cast<const Lane*>(boxes.low[i].data());
    const Lane high = *reinterpret_cast<const Lane*>(boxes.high[i].data());
    all &= (EightBits)(low <= box.high[i]) & (EightBits)(high >= box.low[i]);
  }
  return together(all);
}

}  // namespace tegotae
