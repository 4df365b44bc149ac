#pragma once

#include "mesh/topology.hpp"
#include "narrowphase/patch_tree.hpp"

namespace tegotae {

/// Whether two faces of the surface may meet in anything but the corners and edges that they share, or come nearer than
/// rounding can tell. Faces whose normal is not known (thinner than kThinFace of their longest edge) count as meeting.
/// `topology` is that of the tree's mesh, which is closed. Some 3 µs a triangle, by all processors.
bool meets_itself(const PatchTree& tree, const Topology& topology);

/// Faces thinner than this part of their longest edge have no normal to rely on.
inline constexpr double kThinFace = 1e-6;

}  // namespace tegotae
