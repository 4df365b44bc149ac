#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tegotae/loop/scene.hpp"

namespace tegotae::experiments {

/// A block of half widths `half` (m) a hair above a floor.
Scene block_on_floor(const Vec3& half, double mu);
/// A plate of 40 × 40 × 10 mm between two others, with so much play (m).
Scene plate_in_slot(double play, double mu);
/// A peg in a hole of 20 mm, without chamfers, its tip `depth` (m) under the rim, with so much radial play (m).
Scene peg_in_hole(double depth, double play, double mu);
inline constexpr double kPegRadius = 0.01, kPegLength = 0.05;

/// A part that sticks until its load passes a threshold that is known in closed form.
struct Threshold {
  std::string name, formula;
  double expected;
  Scene scene;
  /// Of the parameter whose threshold is asked for; the part sticks at `from` and slides at `to` times what is
  /// expected.
  std::function<Wrench(double)> load;
  double from, to;
};

/// Incline (slide and tip), V-groove, collar on a post, spin on four corners; fewer of each when `quick`.
std::vector<Threshold> thresholds(bool quick);

}  // namespace tegotae::experiments
