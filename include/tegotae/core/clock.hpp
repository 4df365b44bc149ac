#pragma once

#include <time.h>

#include <cstdint>

namespace tegotae {

/// Time of the monotonic clock, ns. The same clock in every process of the machine.
inline std::int64_t monotonic_ns() noexcept {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

}  // namespace tegotae
