#pragma once

#include "narrowphase/patch_lanes.hpp"
#include "narrowphase/patch_separate.hpp"

namespace tegotae {

/// What the wide check needs to know of the sizes of two parts, m.
struct PairSizes {
  double reach_a;   ///< bounds points of A's boxes about A's center of mass
  double radius_a;  ///< and of its triangles
  double reach_b;   ///< bounds points of B's boxes about the origin of B's tree
  double radius_b;  ///< and of its triangles
};

/// The motion as B sees it: pieces of A go past planes that are fixed to B.
LaneSweep seen_from_b(const Sweep& sweep, const PairSizes& sizes);

/// The motion as A sees it: pieces of B, in B's axes and relative to the origin of B's tree, go past planes that are
/// fixed to A, with normals from A to B (docs/decisions/0094-planes-that-turn-with-the-part.md).
LaneSweep seen_from_a(const Sweep& sweep, const PairSizes& sizes);

}  // namespace tegotae
