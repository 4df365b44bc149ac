#include "stress_script.hpp"

#include <algorithm>
#include <cmath>

#include "bodies.hpp"

namespace tegotae::test {
namespace {

constexpr double kTick = 1e-3;  // s
// Hand speeds are for parts of this radius (m); larger ones move in proportion, or they would hardly move at all.
constexpr double kHandSize = 0.05;
constexpr int kLongestPhase = 60;  // ticks

Pose posed(const Vec3& dp, const Vec3& dr, const Pose& from) {
  const double angle = dr.norm();
  const Quat turn = angle > 0 ? Quat(Eigen::AngleAxisd(angle, Vec3(dr / angle))) : Quat(Quat::Identity());
  return {(turn * from.q).normalized(), from.p + dp};
}

}  // namespace

StressScript::StressScript(unsigned seed, const Pose& start, const Vec3& center, double size, const Envelope& envelope)
    : rng_(seed), home_{start.q, start * center}, center_(center), size_(size), envelope_(envelope), from_(home_) {
  begin_phase();
}

Vec3 StressScript::direction() {
  return random_direction(rng_);
}

void StressScript::begin_phase() {
  enum Kind { fine, wide, fast, jump, spin, rest };
  std::discrete_distribution<int> pick{3, 3, 2, 1, 1, 1};
  const Kind kind = static_cast<Kind>(pick(rng_));
  at_ = 0;
  dp_ = dr_ = Vec3::Zero();
  if (kind == rest) {
    ticks_ = 25;
    return;
  }
  const double share = kind == fine ? 0.1 : 1.0;
  const bool anywhere = kind != fine && uniform(0, 1) < 0.15;
  Vec3 goal = home_.p + envelope_.offset;
  for (int k = 0; k < 3; ++k) goal[k] += share * envelope_.reach[k] * uniform(-1, 1);
  const Quat turned = posed(Vec3::Zero(), uniform(0, anywhere ? 3.0 : share * envelope_.tilt) * direction(), home_).q;
  dp_ = goal - from_.p;
  const Eigen::AngleAxisd turn((turned * from_.q.conjugate()).normalized());
  dr_ = turn.angle() * turn.axis();
  const double scale = std::max(1.0, size_ / kHandSize);
  const double speed = scale * (kind == fine ? uniform(0.01, 0.1) : kind == wide ? uniform(0.05, 0.5) : 2.0);
  const double rate = kind == fine ? 0.5 : kind == wide ? uniform(0.5, 4) : 20.0;
  const double needed = std::max(dp_.norm() / speed, dr_.norm() / rate) / kTick;
  ticks_ = std::clamp(static_cast<int>(std::ceil(std::min(needed, 1e6))), 1, kLongestPhase);
  if (kind == jump) ticks_ = 1;
  if (kind == spin) {
    ticks_ = 40;
    dr_ = uniform(5, 20) * kTick * ticks_ * direction();
  }
}

Pose StressScript::next() {
  if (at_ == ticks_) {
    from_ = posed(dp_, dr_, from_);
    begin_phase();
  }
  ++at_;
  const double s = static_cast<double>(at_) / ticks_;
  // Starts and ends at rest, but for jumps.
  const double smooth = s * s * (3 - 2 * s);
  const Pose c = posed(smooth * dp_, smooth * dr_, from_);
  return {c.q, c.p - c.q * center_};
}

}  // namespace tegotae::test
