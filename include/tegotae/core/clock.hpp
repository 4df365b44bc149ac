#pragma once

#include <time.h>

#include <cstdint>
#include <limits>

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Returns the time of the monotonic clock, ns. All processes of the machine share this clock.
inline std::int64_t monotonic_ns() noexcept {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

/// A deadline that never comes. past() does not read the clock for it.
inline constexpr std::int64_t kNoDeadline = std::numeric_limits<std::int64_t>::max();

/// Returns whether `deadline_ns`, a time of monotonic_ns(), has passed.
inline bool past(std::int64_t deadline_ns) noexcept {
  return deadline_ns != kNoDeadline && monotonic_ns() >= deadline_ns;
}

}  // namespace tegotae
