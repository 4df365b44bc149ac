#pragma once

#include <array>
#include <cstddef>

#include "tegotae/core/pose.hpp"

namespace tegotae {

/// What the eye tells, late: poses with their times, read as they were a while ago.
class DelayedView {
 public:
  /// The pose at `t` (s), later than those before. Pictures come at 1 kHz at most; nearer ones are left out.
  void add(double t, const Pose& X) noexcept {
    if (count_ > 0 && t - last().t < kSpacing) return;
    ring_[count_++ % kCapacity] = {t, X};
  }
  /// The newest pose not younger than `t`'s, or the oldest kept; null before the first.
  const Pose* at(double t) const noexcept {
    if (count_ == 0) return nullptr;
    const std::size_t oldest = count_ > kCapacity ? count_ - kCapacity : 0;
    std::size_t i = count_ - 1;
    while (i > oldest && ring_[i % kCapacity].t > t) --i;
    return &ring_[i % kCapacity].X;
  }

 private:
  // 0.5 s of a picture each 0.95 ms: more than the longest visual delay, and a clock of 1 ms never skips by rounding.
  static constexpr std::size_t kCapacity = 512;
  static constexpr double kSpacing = 0.95e-3;
  struct Picture {
    double t;
    Pose X;
  };
  const Picture& last() const { return ring_[(count_ - 1) % kCapacity]; }
  std::array<Picture, kCapacity> ring_;
  std::size_t count_ = 0;
};

}  // namespace tegotae
