#pragma once

#include <time.h>

#include <cstdint>
#include <limits>

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Time of the monotonic clock, ns. The same clock in every process of the machine.
inline std::int64_t monotonic_ns() noexcept {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

/// A deadline that never comes; asking for it does not read the clock.
inline constexpr std::int64_t kNoDeadline = std::numeric_limits<std::int64_t>::max();

/// Whether `deadline_ns` of monotonic_ns() has passed.
inline bool past(std::int64_t deadline_ns) noexcept {
  return deadline_ns != kNoDeadline && monotonic_ns() >= deadline_ns;
}

}  // namespace tegotae
