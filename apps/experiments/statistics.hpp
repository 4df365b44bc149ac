#pragma once

#include <vector>

#include "tegotae/core/pose.hpp"

namespace tegotae::experiments {

struct Spread {
  double mean = 0, deviation = 0;  ///< deviation: of the sample (n − 1); NaN for fewer than two values
  double low = 0, high = 0;        ///< ends of the 95 % confidence interval of the mean (normal approximation)
};
/// NaN throughout for no value.
Spread spread(const std::vector<double>& values);

/// Root mean square of what changes faster than `hz` in values taken every `dt` seconds: the straight line is taken
/// off, a Hann window keeps the ends from counting, and the spectrum above `hz` is summed (Parseval). 0 below eight
/// values.
double rms_above(const std::vector<double>& values, double dt, double hz);
/// The same of the length of a vector: root of the sum of the squares of its coordinates.
double rms_above(const std::vector<Vec3>& values, double dt, double hz);

/// Jonckheere and Terpstra's test of a trend over ordered groups, in strata that are not compared with each other.
struct Trend {
  double z = 0;  ///< standardized statistic, positive when values rise with the group
  double p = 1;  ///< one-sided: chance of at least such a rise when the groups do not differ (normal approximation)
};
/// strata[s][g] are the values of group g in stratum s. Statistic, mean and variance of the strata add up. Ties count a
/// half; the variance is that without ties, which is never too small.
Trend jonckheere(const std::vector<std::vector<std::vector<double>>>& strata);

/// Slope of the least-squares line through (x, y).
double slope(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace tegotae::experiments
