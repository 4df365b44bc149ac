#pragma once

#include <vector>

#include "curve/axis_search.hpp"
#include "narrowphase/profile_tree.hpp"

namespace tegotae {

/// find_axes(), or what it found before: read from the cache, or kept there.
std::vector<ScrewAxis> cached_axes(const TriangleMesh& mesh);
/// ProfileTree(tree, frame), in the same way.
ProfileTree cached_profile(const PatchTree& tree, const ScrewFrame& frame);

}  // namespace tegotae
