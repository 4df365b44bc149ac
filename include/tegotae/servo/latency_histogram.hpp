#pragma once

#include <array>
#include <cstdint>

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Counts durations from 0 to hours in bins of at most 1/32 of their value, without allocation.
class LatencyHistogram {
 public:
  /// A negative duration counts as 0.
  void add(std::int64_t ns) noexcept;
  std::uint64_t count() const noexcept { return count_; }
  std::int64_t max_ns() const noexcept { return max_; }  ///< exact; 0 when empty
  /// The smallest duration that at least the part `p` (in [0, 1]) of all does not exceed, in ns: exact or up to 1/32
  /// too large, never above max_ns(); 0 when empty.
  std::int64_t percentile_ns(double p) const noexcept;

 private:
  static constexpr int kBitsPerOctave = 5;
  static constexpr int kOctaves = 44;  // up to 2^44 ns, about five hours; longer ones count in the last bin
  std::array<std::uint64_t, kOctaves << kBitsPerOctave> bins_{};
  std::uint64_t count_ = 0;
  std::int64_t max_ = 0;
};

/// In microseconds.
struct LatencySummary {
  double p50 = 0;
  double p99 = 0;
  double p999 = 0;
  double max = 0;
};
LatencySummary summary(const LatencyHistogram& histogram) noexcept;

}  // namespace tegotae
