#pragma once

#include <array>
#include <random>

#include "tegotae/core/pose.hpp"

namespace tegotae {

inline constexpr double kTwoPi = 6.283185307179586;

/// Physiological tremor: in each of six coordinates a sum of sines with frequencies spread over 8 to 12 Hz and random
/// phases. Stationary, and all its power is in the band.
class Tremor {
 public:
  static constexpr double kLowestHz = 8, kHighestHz = 12;

  /// `position_rms` (m) and `rotation_rms` (rad) are those of each coordinate.
  Tremor(double position_rms, double rotation_rms, std::mt19937_64& rng);

  struct Value {
    Displacement d;
    Twist rate;
  };
  /// At `t` (s), and how fast it changes.
  Value at(double t) const noexcept;

 private:
  static constexpr int kSines = 5;
  struct Sine {
    double w, phase;  // rad/s, rad
  };
  std::array<std::array<Sine, kSines>, 6> sines_;
  double position_amplitude_, rotation_amplitude_;
};

}  // namespace tegotae
