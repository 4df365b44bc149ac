#include "operator/tremor.hpp"

#include <cmath>

namespace tegotae {
namespace {}  // namespace

Tremor::Tremor(double position_rms, double rotation_rms, std::mt19937_64& rng)
    : position_amplitude_(position_rms * std::sqrt(2.0 / kSines)),
      rotation_amplitude_(rotation_rms * std::sqrt(2.0 / kSines)) {
  std::uniform_real_distribution<double> u(0, 1);
  for (auto& coordinate : sines_) {
    for (int i = 0; i < kSines; ++i) {
      // One in each fifth of the band: two equal ones would beat for seconds.
      const double hz = kLowestHz + (kHighestHz - kLowestHz) * (i + u(rng)) / kSines;
      coordinate[static_cast<std::size_t>(i)] = {kTwoPi * hz, kTwoPi * u(rng)};
    }
  }
}

Tremor::Value Tremor::at(double t) const noexcept {
  Vec6 x = Vec6::Zero(), v = Vec6::Zero();
  for (int k = 0; k < 6; ++k) {
    for (const Sine& s : sines_[static_cast<std::size_t>(k)]) {
      const double angle = s.w * t + s.phase;
      x[k] += std::sin(angle);
      v[k] += s.w * std::cos(angle);
    }
  }
  Value out;
  out.d = {position_amplitude_ * x.head<3>(), rotation_amplitude_ * x.tail<3>()};
  out.rate = {position_amplitude_ * v.head<3>(), rotation_amplitude_ * v.tail<3>()};
  return out;
}

}  // namespace tegotae
