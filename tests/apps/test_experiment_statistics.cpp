// The statistics of the experiments against published and closed-form values.
#include <cmath>
#include <vector>

#include "catch.hpp"
#include "experiments/parallel.hpp"
#include "experiments/statistics.hpp"

using namespace tegotae::experiments;

TEST_CASE("the trend test gives published values", "[statistics]") {
  // Bewick, Cheek and Ball, "Statistics review 10", Critical Care 8, 2004: days in three intensive-care units. The sums
  // of U are 23, 34.5 and 19.5, and p is given as 0.005.
  const Trend icu = jonckheere({{{7, 1, 2, 6, 11, 8}, {4, 7, 16, 11, 21}, {20, 25, 13, 9, 14, 11}}});
  CHECK(icu.z == Approx((23 + 34.5 + 19.5 - 48) / std::sqrt(129.0)).epsilon(1e-12));
  CHECK(icu.p == Approx(0.005).margin(0.0005));
  // Hollander and Wolfe, "Nonparametric Statistical Methods", pieces made by three groups: J = 79, mean 54, variance
  // 153, so J* = 2.02.
  const Trend pieces = jonckheere({{{40, 35, 38, 43, 44, 41}, {38, 40, 47, 44, 40, 42}, {48, 40, 45, 43, 46, 44}}});
  CHECK(pieces.z == Approx(2.02).margin(0.005));
}

TEST_CASE("a trend turns round with its values, and strata add up", "[statistics]") {
  const Trend up = jonckheere({{{1, 2}, {3, 4}, {5, 6}}}), down = jonckheere({{{-1, -2}, {-3, -4}, {-5, -6}}});
  CHECK(up.z == Approx(-down.z));
  CHECK(up.p + down.p == Approx(1));
  const Trend both = jonckheere({{{1, 2}, {3, 4}, {5, 6}}, {{101, 102}, {103, 104}, {105, 106}}});
  CHECK(both.z == Approx(std::sqrt(2.0) * up.z));
  CHECK(jonckheere({{{1, 1}, {1, 1}}}).z == 0);
  CHECK(jonckheere({}).p == 1);
}

TEST_CASE("what is above 30 Hz is told from what is below", "[statistics]") {
  std::vector<double> slow, mixed;
  for (int i = 0; i < 3000; ++i) {
    const double t = 1e-3 * i;
    slow.push_back(5 * t + 0.2 * std::sin(2 * M_PI * 10 * t));
    mixed.push_back(slow.back() + 0.01 * std::sin(2 * M_PI * 80 * t + 1));
  }
  CHECK(rms_above(slow, 1e-3, 30) < 1e-5);
  CHECK(rms_above(mixed, 1e-3, 30) == Approx(0.01 / std::sqrt(2.0)).epsilon(0.01));
  CHECK(rms_above(std::vector<double>{1, 2}, 1e-3, 30) == 0);
}

TEST_CASE("mean, deviation, interval and slope", "[statistics]") {
  const Spread s = spread({2, 4, 4, 4, 5, 5, 7, 9});
  CHECK(s.mean == Approx(5));
  CHECK(s.deviation == Approx(std::sqrt(32.0 / 7)));
  CHECK(s.high - s.mean == Approx(1.96 * std::sqrt(32.0 / 7 / 8)));
  CHECK(std::isnan(spread({}).mean));
  CHECK(slope({1, 2, 3, 4}, {3, 5, 7, 9}) == Approx(2));
}

TEST_CASE("every job is done once on any number of threads, and a failure comes out", "[statistics]") {
  tegotae::apps::StatusLine status;
  for (const int threads : {1, 2, 5}) {
    Options options;
    options.threads = threads;
    const Work work{options, status};
    std::vector<int> done(100, 0);
    work.each("count", 100, [&](int i) { ++done[static_cast<std::size_t>(i)]; });
    CHECK(done == std::vector<int>(100, 1));
    CHECK_THROWS_AS(work.each("fail", 10,
                              [](int i) {
                                if (i == 3) throw std::runtime_error("three");
                              }),
                    std::runtime_error);
  }
}
