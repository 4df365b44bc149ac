#include "experiments/statistics.hpp"

#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>

#include "core/numbers.hpp"

namespace tegotae::experiments {
namespace {

constexpr double kTwoPi = 6.283185307179586;

double sum_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum;
}

}  // namespace

Spread spread(const std::vector<double>& values) {
  if (values.empty()) return {kNan, kNan, kNan, kNan};
  const double n = static_cast<double>(values.size());
  Spread s;
  s.mean = sum_of(values) / n;
  double squares = 0;
  for (const double v : values) squares += (v - s.mean) * (v - s.mean);
  s.deviation = n > 1 ? std::sqrt(squares / (n - 1)) : kNan;
  const double half = 1.96 * s.deviation / std::sqrt(n);
  s.low = s.mean - half;
  s.high = s.mean + half;
  return s;
}

double rms_above(const std::vector<double>& values, double dt, double hz) {
  const std::size_t count = values.size();
  if (count < 8) return 0;
  const double n = static_cast<double>(count);
  std::vector<double> time(count), windowed(count);
  for (std::size_t i = 0; i < count; ++i) time[i] = static_cast<double>(i);
  const double b = slope(time, values), a = sum_of(values) / n - b * sum_of(time) / n;
  double weight = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double w = 0.5 - 0.5 * std::cos(kTwoPi * (time[i] + 0.5) / n);
    windowed[i] = w * (values[i] - a - b * time[i]);
    weight += w * w;
  }
  std::vector<std::complex<double>> spectrum;
  Eigen::FFT<double> fft;
  fft.fwd(spectrum, windowed);
  double power = 0;
  for (std::size_t k = 1; 2 * k <= count; ++k) {
    if (static_cast<double>(k) / (dt * n) < hz) continue;
    power += (2 * k == count ? 1 : 2) * std::norm(spectrum[k]);
  }
  return std::sqrt(power / (n * weight));
}

double rms_above(const std::vector<Vec3>& values, double dt, double hz) {
  double squares = 0;
  std::vector<double> one(values.size());
  for (int k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < values.size(); ++i) one[i] = values[i][k];
    const double r = rms_above(one, dt, hz);
    squares += r * r;
  }
  return std::sqrt(squares);
}

Trend jonckheere(const std::vector<std::vector<std::vector<double>>>& strata) {
  double statistic = 0, mean = 0, variance = 0;
  for (const auto& groups : strata) {
    double n = 0, squares = 0, cubes = 0;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const double m = static_cast<double>(groups[g].size());
      n += m;
      squares += m * m;
      cubes += m * m * (2 * m + 3);
      for (std::size_t lower = 0; lower < g; ++lower)
        for (const double a : groups[lower])
          for (const double b : groups[g]) statistic += a < b ? 1.0 : a == b ? 0.5 : 0.0;
    }
    mean += (n * n - squares) / 4;
    variance += (n * n * (2 * n + 3) - cubes) / 72;
  }
  if (!(variance > 0)) return {};
  Trend t;
  t.z = (statistic - mean) / std::sqrt(variance);
  t.p = 0.5 * std::erfc(t.z / std::sqrt(2.0));
  return t;
}

double slope(const std::vector<double>& x, const std::vector<double>& y) {
  const double n = static_cast<double>(x.size()), mx = sum_of(x) / n, my = sum_of(y) / n;
  double xy = 0, xx = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xy += (x[i] - mx) * (y[i] - my);
    xx += (x[i] - mx) * (x[i] - mx);
  }
  return xx > 0 ? xy / xx : 0;
}

}  // namespace tegotae::experiments
