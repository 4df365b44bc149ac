#pragma once

#include <limits>

#include "tegotae/core/pose.hpp"

namespace tegotae {

/// How far ahead of A its way has been looked at, in the direction in which it goes. Lengths are of the points that the
/// motion carries farthest, m.
class Headway {
 public:
  /// At most `longest`; turns are about `center` (file frame), from which A's points are up to `radius` away.
  Headway(const Vec3& center, double radius, double longest) : center_(center), radius_(radius), longest_(longest) {}

  /// A is at `X` and about to move by `d` (world): in a direction of its own all begins anew. False where it rests.
  bool go(const Pose& X, const Displacement& d) noexcept;
  /// The motion to look at next; nothing when enough is known.
  bool wants_more() const;
  /// As far as is worth a look in the direction of the last go().
  Displacement motion() const { return motion_of(target()); }
  /// Of motion() at least the share `proved` is free, and at `met`, unless that is 1, something is in its way.
  void learn(double proved, double met) noexcept;
  /// Nothing is known any longer.
  void restart() noexcept;

 private:
  double target() const;
  Displacement motion_of(double length) const;

  Vec3 center_;
  double radius_, longest_;
  Pose X_;
  Displacement step_;  ///< of the last go()
  double carried_ = 0;
  double proved_ = 0;  ///< the way is free so far, at least
  double met_ = std::numeric_limits<double>::infinity();
};

}  // namespace tegotae
