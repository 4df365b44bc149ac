#pragma once

#include <memory>

#include "narrowphase/patch_tree.hpp"

namespace tegotae {

/// Smaller meshes are built faster than this is worth.
inline constexpr std::size_t kMinCached = 20000;  // triangles; 50 ms

/// The hierarchy over `mesh`: the one in use by others, read from the folder of set_hierarchy_cache, or built and kept
/// there.
std::shared_ptr<const PatchTree> cached_patch_tree(const std::shared_ptr<const TriangleMesh>& mesh);

}  // namespace tegotae
