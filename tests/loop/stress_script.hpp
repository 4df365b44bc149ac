// Random pens for the stress runs.
#pragma once

#include <random>

#include "tegotae/core/pose.hpp"

namespace tegotae::test {

/// Where a random pen roams.
struct Envelope {
  Vec3 reach;                  ///< half extents of the goals of its center of mass along the world's axes, m
  double tilt;                 ///< largest rotation from the start of most goals, rad
  Vec3 offset = Vec3::Zero();  ///< of the middle of the goals from where the held part starts, m
};

/// A pen that strings together phases: fine and wide smooth motions, 2 m/s and 20 rad/s, jumps, spins, rests. The same
/// seed gives the same pen.
class StressScript {
 public:
  /// `start`: pose of the held part's file frame; `center`: its center of mass (m, file frame); `size`: radius (m)
  /// about it.
  StressScript(unsigned seed, const Pose& start, const Vec3& center, double size, const Envelope& envelope);

  /// The pose of the pen (of the held part's file frame) one tick of 1 ms later.
  Pose next();

 private:
  void begin_phase();
  double uniform(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(rng_); }
  Vec3 direction();

  std::mt19937 rng_;
  Pose home_;  ///< the frame of the center of mass with the file frame's axes, at the start
  Vec3 center_;
  double size_;
  Envelope envelope_;
  Pose from_;      ///< of the phase
  Vec3 dp_, dr_;   ///< of the phase
  int ticks_ = 0;  ///< of the phase
  int at_ = 0;
};

}  // namespace tegotae::test
