#pragma once

#include <vector>

#include "experiments/wrench_scenes.hpp"

namespace tegotae::experiments {

/// Parts without symmetry (bar, L, tetrahedron; 2 mm to half a meter) in cages of six planes at random places, each
/// before a corner of the part. Pushed and turned at random they rest on one to six corners. The wrench is that of the
/// pose in which the coupling's springs store least, found by trying every set of corners.
std::vector<WrenchScene> cage_scenes(int probes);

}  // namespace tegotae::experiments
