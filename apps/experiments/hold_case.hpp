#pragma once

#include <string>

namespace tegotae::experiments {

/// What moved in half a second under a still pen; all zero when nothing touches in the end.
struct Held {
  bool touching = false;
  double moved = 0;         ///< peak to peak of the center of mass, largest coordinate, m
  double turned = 0;        ///< peak to peak of the rotation, largest coordinate, rad
  double force_change = 0;  ///< peak to peak of the force by its largest value
};

/// A random body that the pen pushes between two to four others and then holds still: half a second to push, half to
/// settle, half watched. `seed` makes the bodies (odd: convex, even: star-shaped) and the way.
Held hold_case(const std::string& resolver, unsigned seed);

}  // namespace tegotae::experiments
