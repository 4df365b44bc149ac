// A hand that brings a peg to a hole it does not quite see, as a script: for fits of every tightness.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "tegotae/device/script.hpp"

namespace tegotae::test {

/// How an insertion begins. World z points up out of the hole, whose rim is at z = 0 and whose axis is z.
struct LadderStart {
  double tilt = 0;    ///< of the peg's axis, rad
  double offset = 0;  ///< of the tip from the hole's axis, m
  unsigned seed = 1;  ///< directions of tilt and offset, tremor, and what the eye gets wrong
};

/// Down on the rim, pressed while nothing goes on, straightened and rocked towards the hole, pushed to its bottom with
/// a tremor, and 1 mm more. What stays wrong by eye: up to 0.15 mm and 0.3 degrees. `half_length` of the peg whose file
/// frame is at its middle, `depth` of the hole (m).
inline StylusScript ladder_script(const LadderStart& start, double half_length, double depth) {
  std::mt19937 rng(start.seed);
  std::uniform_real_distribution<double> u(0, 1);
  const double deg = M_PI / 180, a_tilt = 2 * M_PI * u(rng), a_offset = 2 * M_PI * u(rng), a_wrong = 2 * M_PI * u(rng);
  const double wrong_tilt = 0.3 * deg * u(rng), wrong_offset = 1.5e-4 * u(rng), rock_phase = 2 * M_PI * u(rng);
  const double tremor_hz = 8 + 4 * u(rng), rock_hz = 1.5 + u(rng);
  const auto smooth = [](double s) { return s <= 0 ? 0.0 : s >= 1 ? 1.0 : s * s * s * (10 + s * (6 * s - 15)); };
  const auto around = [](double angle) { return Vec3(std::cos(angle), std::sin(angle), 0); };
  std::vector<StylusScript::Key> keys;
  for (int i = 0; i <= 750; ++i) {
    const double t = 0.01 * i;
    const double straight = smooth((t - 1.2) / 2.0);
    // Rocking swells while it is stuck and dies away on the way down.
    const double rock = 1.2 * deg * smooth((t - 1.2) / 0.5) * (1 - 0.85 * smooth((t - 3.0) / 1.5));
    const double turn = 2 * M_PI * 0.4 * t + rock_phase;
    const Vec3 tilt = (start.tilt * (1 - straight)) * around(a_tilt) + (straight * wrong_tilt) * around(a_wrong) +
                      rock * std::sin(2 * M_PI * rock_hz * t) * around(turn);
    const double shake = 5e-5 * std::sin(2 * M_PI * tremor_hz * t);
    Vec3 tip = (start.offset * (1 - straight)) * around(a_offset) + (straight * wrong_offset) * around(a_wrong + 1) +
               shake * around(turn + 1);
    tip.z() = 5e-3 - 7e-3 * smooth(t / 1.0) - 4e-3 * smooth((t - 2.0) / 2.0) - (depth - 5e-3) * smooth((t - 4.0) / 2.5);
    Pose X;
    X.q = rotation({-tilt.y(), tilt.x(), 0});
    X.p = tip + X.q * Vec3(0, 0, half_length);
    keys.push_back({t, X});
  }
  return StylusScript(std::move(keys));
}

}  // namespace tegotae::test
