#pragma once

#include "loop/collision_world.hpp"

namespace tegotae {

/// Parts the held part at `X` from the fixed parts that it touches by less than kGapFloor: the least displacement in
/// the mass metric that leaves kGapFloor to all of them, found by the program over the contacts with their smaller
/// copies; if there is none of at most `most` (m, for any point), as many of them as can be, one after the other. The
/// way there is certified like every other motion. Returns the new pose; freed pairs are active in `at.start`.
Pose initial_separation(CollisionWorld& at, const MassProperties& mass, const Pose& X, double most);

}  // namespace tegotae
