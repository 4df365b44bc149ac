#pragma once

#include <cstdint>

namespace tegotae {

/// A triangle of the held part A and one of the fixed part B number `part`.
struct FacePair {
  std::uint32_t part;
  std::uint32_t a;
  std::uint32_t b;
};

}  // namespace tegotae
