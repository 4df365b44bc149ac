#pragma once

#include <vector>

#include "experiments/friction_scenes.hpp"

namespace tegotae::experiments {

/// A screw in its nut: ISO metric, flanks of 60°.
struct Screw {
  const char* name;
  double pitch;           ///< m
  double pitch_diameter;  ///< m
  /// tan of the lead angle, and cos of the flank's angle in the plane normal to the lead.
  double lead() const;
  double flank() const;
};
const std::vector<Screw>& screws();

/// A screw under an axial load whose tips stand on its flank at three places: the torques that raise and lower it, a
/// taper that is pressed into its seat, and a rope's way round a post, corner by corner.
std::vector<Threshold> tip_thresholds(bool quick);

/// The coefficient of friction from which on the loaded screw holds itself, by bisection with the contact loop.
double self_locking_mu(const Screw& screw);

}  // namespace tegotae::experiments
