#include "narrowphase/block_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tegotae {
namespace {

/// A difference of normals counts as this share of what blocks extend to: what looks the other way is as far away as
/// the farthest.
constexpr float kNormalScale = 0.5F;

/// Where a block is, which way it looks, and its size.
constexpr std::size_t kAxes = 7;

float along(const BlockPlace& block, std::size_t axis) {
  if (axis < 3) return block.middle[axis];
  return axis < 6 ? block.normal[axis - 3] : block.size;
}

std::size_t longest_axis(const std::vector<BlockPlace>& blocks, const std::uint32_t* first, const std::uint32_t* last) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  std::array<float, kAxes> low, high;
  low.fill(kFar);
  high.fill(-kFar);
  for (const std::uint32_t* i = first; i != last; ++i) {
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const float x = along(blocks[*i], axis);
      low[axis] = std::min(low[axis], x);
      high[axis] = std::max(high[axis], x);
    }
  }
  const float diagonal = std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
  std::size_t longest = 0;
  float length = -1;
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const float scale = axis < 3 || axis == 6 ? 1 : kNormalScale * diagonal;
    const float extent = scale * (high[axis] - low[axis]);
    if (extent > length) {
      length = extent;
      longest = axis;
    }
  }
  return longest;
}

/// `each`: the blocks of a full node below.
void order(const std::vector<BlockPlace>& blocks, std::uint32_t* first, std::size_t count, std::size_t each,
           std::uint32_t fan) {
  while (count <= each && each > 1) each /= fan;
  if (count <= each) return;
  const std::size_t nodes = (count + each - 1) / each, half = (nodes + 1) / 2 * each;
  const std::size_t axis = longest_axis(blocks, first, first + count);
  std::nth_element(first, first + half, first + count,
                   [&](std::uint32_t a, std::uint32_t b) { return along(blocks[a], axis) < along(blocks[b], axis); });
  order(blocks, first, half, each, fan);
  order(blocks, first + half, count - half, each, fan);
}

}  // namespace

std::vector<std::uint32_t> order_by_nodes(const std::vector<BlockPlace>& blocks, std::uint32_t fan) {
  std::vector<std::uint32_t> out(blocks.size());
  std::iota(out.begin(), out.end(), 0U);
  std::size_t each = 1;
  while (each * fan < blocks.size()) each *= fan;
  order(blocks, out.data(), out.size(), each, fan);
  return out;
}

}  // namespace tegotae
