#include "device/velocity_filter.hpp"

#include <cmath>

namespace tegotae {

namespace {
constexpr double kTwoPi = 6.283185307179586;
}

void VelocityFilter::add(const Vec3& point, const Quat& rotation, std::int64_t time_ns) noexcept {
  if (sampled_ && time_ns > time_ns_) {
    const double dt = 1e-9 * static_cast<double>(time_ns - time_ns_);
    const double gain = 1.0 - std::exp(-kTwoPi * cutoff_hz_ * dt);
    filtered_.v += gain * ((point - point_) / dt - filtered_.v);
    filtered_.w += gain * (rotation_vector(rotation * rotation_.conjugate()) / dt - filtered_.w);
  }
  sampled_ = true;
  time_ns_ = time_ns;
  point_ = point;
  rotation_ = rotation;
}

}  // namespace tegotae
