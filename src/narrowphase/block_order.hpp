#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace tegotae {

/// Where a block of faces is, m, and which way it looks, as the mean of its faces' unit normals.
struct BlockPlace {
  std::array<float, 3> middle, normal;
  float size;  ///< its longest extent, m
};

/// An order of blocks in which each `fan` in a row, and each `fan` of those, are near each other, look about the same
/// way and are about as large, as far as that can be: the order of a hierarchy of full nodes. By halves from above.
std::vector<std::uint32_t> order_by_nodes(const std::vector<BlockPlace>& blocks, std::uint32_t fan);

}  // namespace tegotae
