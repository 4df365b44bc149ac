#pragma once

#include "tegotae/loop/scene.hpp"

namespace tegotae::experiments {

/// How far a held part goes when it is pressed either way.
struct Clearance {
  double play = 0;     ///< from one stop to the other, m
  double deepest = 0;  ///< of a vertex inside another part when pressed, m; zero unless the resolver is "penalty"
  bool held = false;   ///< both ways it was stopped, at rest and pushed back with the force
};

/// Presses the held part of `scene` from `X` along `direction` (unit, world) and against it with `force` (N), the pen
/// leading by force / coupling stiffness and keeping the orientation of `X`, until it stands still. What a rigid part
/// in a rigid hole has as play is its clearance; what it has more is the hole grown by the resolver.
Clearance measure_clearance(Scene scene, const Pose& X, const Vec3& direction, double force);

}  // namespace tegotae::experiments
