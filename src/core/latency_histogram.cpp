#include "tegotae/core/latency_histogram.hpp"

#include <algorithm>
#include <cmath>

namespace tegotae {

// Bins are those of a floating-point number with kBitsPerOctave bits of mantissa: values below 2^(kBitsPerOctave + 1)
// have a bin each, above every octave has 2^kBitsPerOctave bins.

void LatencyHistogram::add(std::int64_t ns) noexcept {
  const std::uint64_t value = ns > 0 ? static_cast<std::uint64_t>(ns) : 0;
  int shift = 0;
  while ((value >> shift) >= (std::uint64_t{2} << kBitsPerOctave)) ++shift;
  const std::size_t bin =
      (static_cast<std::size_t>(shift) << kBitsPerOctave) + static_cast<std::size_t>(value >> shift);
  ++bins_[std::min(bin, bins_.size() - 1)];
  ++count_;
  max_ = std::max(max_, static_cast<std::int64_t>(value));
}

std::int64_t LatencyHistogram::percentile_ns(double p) const noexcept {
  const double wanted = std::ceil(p * static_cast<double>(count_));
  std::uint64_t seen = 0;
  for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
    if (bins_[bin] == 0) continue;
    seen += bins_[bin];
    if (static_cast<double>(seen) < wanted) continue;
    const std::size_t octave = bin >> kBitsPerOctave;
    const std::size_t shift = octave > 0 ? octave - 1 : 0;
    const std::uint64_t mantissa = bin - (shift << kBitsPerOctave);
    const std::uint64_t last = ((mantissa + 1) << shift) - 1;  // largest value of the bin
    return std::min(max_, static_cast<std::int64_t>(last));
  }
  return max_;
}

LatencySummary summary(const LatencyHistogram& histogram) noexcept {
  const auto us = [](std::int64_t ns) { return 1e-3 * static_cast<double>(ns); };
  return {us(histogram.percentile_ns(0.5)), us(histogram.percentile_ns(0.99)), us(histogram.percentile_ns(0.999)),
          us(histogram.max_ns())};
}

}  // namespace tegotae
