#pragma once

#include <memory>

#include "narrowphase/patch_tree.hpp"

namespace tegotae {

/// To be raised whenever PatchTree builds another tree over the same mesh.
inline constexpr std::uint32_t kPatchBuild = 2;

/// The hierarchy over `mesh`: the one in use by others, read from the folder of set_hierarchy_cache, or built and kept
/// there.
std::shared_ptr<const PatchTree> cached_patch_tree(const std::shared_ptr<const TriangleMesh>& mesh);

}  // namespace tegotae
