#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace tegotae {

/// A motion of N coordinates from any state to rest at a target, with the least integral of squared jerk for its
/// duration: a polynomial of fifth degree in each coordinate (Flash & Hogan, "The coordination of arm movements", J.
/// Neurosci. 5, 1985; from a state in motion Hoff & Arbib, J. Motor Behav. 25, 1993). From rest it is the well-known
/// x0 + d (10 s³ − 15 s⁴ + 6 s⁵), whose peak speed is 1.875 d / T at half time.
template <int N>
class MinimumJerk {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  struct State {
    Vector x = Vector::Zero(), v = Vector::Zero(), a = Vector::Zero();
  };

  /// At rest at `x`.
  explicit MinimumJerk(const Vector& x = Vector::Zero()) : target_(x) {}
  /// From `from` at the time `t0` to rest at `target` at t0 + `duration` (> 0).
  MinimumJerk(const State& from, const Vector& target, double t0, double duration)
      : t0_(t0), duration_(duration), target_(target) {
    // In s = (t − t0) / T, measured from the target: c0 + c1 s + ... + c5 s⁵ with p = p' = p'' = 0 at s = 1.
    c_[0] = from.x - target;
    c_[1] = duration * from.v;
    c_[2] = 0.5 * duration * duration * from.a;
    c_[3] = -10.0 * c_[0] - 6.0 * c_[1] - 3.0 * c_[2];
    c_[4] = 15.0 * c_[0] + 8.0 * c_[1] + 3.0 * c_[2];
    c_[5] = -6.0 * c_[0] - 3.0 * c_[1] - c_[2];
  }

  const Vector& target() const { return target_; }
  double end() const { return t0_ + duration_; }

  /// Position, velocity and acceleration at `t`; at rest at the target from end() on.
  State at(double t) const {
    State out;
    out.x = target_;
    if (t >= end()) return out;
    const double T = duration_, s = std::max(0.0, (t - t0_) / T);
    out.x += c_[0] + s * (c_[1] + s * (c_[2] + s * (c_[3] + s * (c_[4] + s * c_[5]))));
    out.v = (c_[1] + s * (2.0 * c_[2] + s * (3.0 * c_[3] + s * (4.0 * c_[4] + s * 5.0 * c_[5])))) / T;
    out.a = (2.0 * c_[2] + s * (6.0 * c_[3] + s * (12.0 * c_[4] + s * 20.0 * c_[5]))) / (T * T);
    return out;
  }

 private:
  double t0_ = 0, duration_ = 0;
  Vector target_;
  Vector c_[6] = {Vector::Zero(), Vector::Zero(), Vector::Zero(), Vector::Zero(), Vector::Zero(), Vector::Zero()};
};

}  // namespace tegotae
