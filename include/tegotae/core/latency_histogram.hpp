#pragma once

#include <array>
#include <cstdint>

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Histogram of durations from 0 to hours. A bin is at most 1/32 of its value wide. It never allocates.
class LatencyHistogram {
 public:
  /// Adds a duration, ns; a negative one counts as 0.
  void add(std::int64_t ns) noexcept;
  std::uint64_t count() const noexcept { return count_; }  ///< durations added
  std::int64_t max_ns() const noexcept { return max_; }    ///< exact; 0 when empty
  /// Returns the smallest duration (ns) that at least the fraction `p` (in [0, 1]) of all durations does not exceed. It
  /// is exact or up to 1/32 too large, never above max_ns(), and 0 when the histogram is empty.
  std::int64_t percentile_ns(double p) const noexcept;

 private:
  static constexpr int kBitsPerOctave = 5;
  static constexpr int kOctaves = 44;  // up to 2^44 ns, about five hours; longer ones count in the last bin
  std::array<std::uint64_t, kOctaves << kBitsPerOctave> bins_{};
  std::uint64_t count_ = 0;
  std::int64_t max_ = 0;
};

/// Summary of many durations, in microseconds; zeros when there are none.
struct LatencySummary {
  double p50 = 0;   ///< median
  double p99 = 0;   ///< 99 of 100 are not longer
  double p999 = 0;  ///< 999 of 1000 are not longer
  double max = 0;   ///< the longest
};
/// Returns the summary of `histogram`, from its percentile_ns() and max_ns().
LatencySummary summary(const LatencyHistogram& histogram) noexcept;

}  // namespace tegotae
