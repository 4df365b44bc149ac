#include "device/velocity_filter.hpp"

#include <algorithm>
#include <cmath>

namespace tegotae {

namespace {
constexpr double kTwoPi = 6.283185307179586;
// Of a step: what is less is not a step but, say, the share of a turn about another axis, and is taken as it is.
constexpr double kStep = 0.5;
// Steps that follow each other within this time (s) are taken as they come: they may be those of a swing, which what
// spreads them over their time would feed by its delay.
constexpr double kSwing = 9e-3;
// A pen without a step for so long (s) stands.
constexpr double kStands = 0.1;
}  // namespace

double VelocityFilter::Axis::add(double moved, double resolution, double dt) noexcept {
  since += dt;
  const double way = std::abs(moved);
  if (!(way > kStep * resolution)) {
    // The next step has not come, and comes a sample later at the earliest.
    const double most = since + dt > kStands ? 0 : resolution / (since + dt);
    rate = std::clamp(rate, -most, most);
    return rate + moved / dt;
  }
  const int towards = moved > 0 ? 1 : -1;
  const bool goes_on = towards == direction && since <= kStands, swings = since < kSwing;
  direction = towards;
  const double hidden = swings ? 0 : std::min(way, resolution);
  rate = goes_on ? towards * hidden / since : 0;
  since = 0;
  return rate + towards * (way - hidden) / dt;
}

Vec3 VelocityFilter::rate(std::array<Axis, 3>& axes, const Vec3& moved, double resolution, double dt) noexcept {
  Vec3 rates;
  for (Eigen::Index i = 0; i < 3; ++i) rates[i] = axes[static_cast<std::size_t>(i)].add(moved[i], resolution, dt);
  return rates;
}

void VelocityFilter::add(const Vec3& point, const Quat& rotation, std::int64_t time_ns) noexcept {
  if (sampled_ && time_ns > time_ns_) {
    const double dt = 1e-9 * static_cast<double>(time_ns - time_ns_);
    const double gain = 1.0 - std::exp(-kTwoPi * cutoff_hz_ * dt);
    const Vec3 turn = rotation_vector(rotation * rotation_.conjugate());
    filtered_.v += gain * (rate(shift_, point - point_, resolution_, dt) - filtered_.v);
    filtered_.w += gain * (rate(turn_, turn, turn_resolution_, dt) - filtered_.w);
  }
  sampled_ = true;
  time_ns_ = time_ns;
  point_ = point;
  rotation_ = rotation;
}

}  // namespace tegotae
