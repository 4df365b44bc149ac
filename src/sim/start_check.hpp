#pragma once

#include "narrowphase/fcl_narrow_phase.hpp"
#include "tegotae/sim/scene.hpp"

namespace tegotae {

/// Throws Error, naming the pair of parts, when the held part `held` starts intersecting one of `fixed` (the number of
/// intersecting triangle pairs is told) or inside of a closed one (or a fixed part inside the closed held one).
void check_start(const Part& held, const std::vector<const Part*>& fixed, FclNarrowPhase& narrow);

}  // namespace tegotae
