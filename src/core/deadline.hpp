#pragma once

#include <cstdint>

#include "tegotae/core/clock.hpp"

namespace tegotae {

/// `seconds` after `now_ns`, ns. Without an end, or with one so far away that the clock would overflow, kNoDeadline.
inline std::int64_t deadline_after(std::int64_t now_ns, double seconds) noexcept {
  constexpr double kLongest = 1e9;  // s; 30 years
  return seconds < kLongest ? now_ns + static_cast<std::int64_t>(1e9 * seconds) : kNoDeadline;
}

}  // namespace tegotae
