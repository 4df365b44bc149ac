#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "mesh/surface.hpp"
#include "narrowphase/patch_tree.hpp"
#include "tegotae/loop/scene.hpp"

namespace tegotae {

/// What a scene's meshes are turned into, each of them once, on all processors. Whoever needs a structure while this
/// lives finds it made.
struct MeshStructures {
  std::map<const TriangleMesh*, std::shared_ptr<const Surface>> surfaces;
  std::map<const TriangleMesh*, std::shared_ptr<const PatchTree>> trees;  ///< none for NarrowPhase::fcl

  /// Calls `progress` (may be empty) before the first structure and after each, with how many of how many there are:
  /// one call at a time, from several threads. Parts without triangles are passed over.
  MeshStructures(const std::vector<Part>& parts, NarrowPhase narrowphase,
                 const std::function<void(std::size_t done, std::size_t total)>& progress = {});
};

}  // namespace tegotae
