#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "catch.hpp"
#include "tegotae/core/latency_histogram.hpp"

using namespace tegotae;

TEST_CASE("percentiles are those of the sorted durations, up to a 32nd", "[servo]") {
  std::mt19937_64 rng(4);
  for (int round = 0; round < 20; ++round) {
    LatencyHistogram histogram;
    std::vector<std::int64_t> all;
    const std::size_t n = 1 + rng() % 3000;
    for (std::size_t i = 0; i < n; ++i) {
      // From nanoseconds to minutes.
      all.push_back(static_cast<std::int64_t>(std::exp(std::uniform_real_distribution<double>(0, 25)(rng))));
      histogram.add(all.back());
    }
    std::sort(all.begin(), all.end());
    REQUIRE(histogram.count() == n);
    REQUIRE(histogram.max_ns() == all.back());
    for (double p : {0.0, 0.1, 0.5, 0.9, 0.99, 0.999, 1.0}) {
      const double rank = std::max(1.0, std::ceil(p * static_cast<double>(n)));
      const double exact = static_cast<double>(all[static_cast<std::size_t>(rank) - 1]);
      const double got = static_cast<double>(histogram.percentile_ns(p));
      REQUIRE(got >= exact);
      REQUIRE(got <= exact * (1 + 1.0 / 32));
    }
  }
}

TEST_CASE("durations out of the ordinary are counted too", "[servo]") {
  LatencyHistogram histogram;
  CHECK(histogram.percentile_ns(0.5) == 0);
  histogram.add(-5);
  CHECK(histogram.percentile_ns(1) == 0);
  histogram.add(std::numeric_limits<std::int64_t>::max());
  CHECK(histogram.count() == 2);
  CHECK(histogram.max_ns() == std::numeric_limits<std::int64_t>::max());
  CHECK(histogram.percentile_ns(0.5) == 0);
}

TEST_CASE("a summary is in microseconds", "[servo]") {
  LatencyHistogram histogram;
  for (int i = 0; i < 1000; ++i) histogram.add(i < 995 ? 10'000 : 64'000);
  const LatencySummary s = summary(histogram);
  CHECK(s.p50 == Approx(10).epsilon(1.0 / 32));
  CHECK(s.p99 == Approx(10).epsilon(1.0 / 32));
  CHECK(s.p999 == 64);
  CHECK(s.max == 64);
}
