#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "tegotae/core/pose.hpp"

namespace tegotae {

/// Where a part was when another motion was proved instead of the one that was asked about. If it is there in a later
/// tick, it did not make that motion, or went to and fro: the same motion would lead nowhere again.
class OfferedMotions {
 public:
  /// Of a part with its center of mass at `center` (m, file frame), of which no point is farther than `radius` from it.
  OfferedMotions(const Vec3& center, double radius) : center_(center), radius_(radius) {}

  /// The motion by `d` from `X` was offered in a tick, counted from 1.
  void add(const Pose& X, const Displacement& d, std::uint64_t tick) noexcept {
    last_[next_] = {X, std::min(kHere, kShareMade * size(d)), tick};
    next_ = (next_ + 1) % last_.size();
  }
  /// Whether one of the last was not made by a part that is at `X` in this tick.
  bool declined(const Pose& X, std::uint64_t tick) const noexcept {
    return std::any_of(last_.begin(), last_.end(), [&](const Offered& o) {
      return o.tick != 0 && o.tick != tick && size(displacement(o.X, X, center_)) < o.here;
    });
  }

 private:
  /// What has come less far (m), and no more than this share of the motion, has not made it.
  static constexpr double kHere = 1e-6, kShareMade = 0.5;

  struct Offered {
    Pose X;
    double here = 0;         ///< what is nearer to it is there, m
    std::uint64_t tick = 0;  ///< 0: none
  };

  double size(const Displacement& d) const { return d.dp.norm() + radius_ * d.dr.norm(); }

  Vec3 center_;
  double radius_;
  std::array<Offered, 4> last_;
  std::size_t next_ = 0;
};

}  // namespace tegotae
