// Where a part first touches others on a straight line, asked of FCL: nothing of the loop takes part.
#pragma once

#include "fcl_oracle.hpp"

namespace tegotae::test {

/// How far (m) the held part may go from `from` along the unit vector `direction` until it is within `near` (m) of a
/// fixed part, at most `most`: steps of the distance that is left can miss nothing, so open surfaces stop it too.
double travel(const FclOracle& oracle, const Pose& from, const Vec3& direction, double most, double near);

/// The same for solids that are guided closely: by bisection between `from`, which is free, and `most` (m) further on,
/// where the parts intersect if they do anywhere; to `near` (m).
double travel_bisected(const FclOracle& oracle, const Pose& from, const Vec3& direction, double most, double near);

}  // namespace tegotae::test
