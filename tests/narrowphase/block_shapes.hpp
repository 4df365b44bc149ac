// Surfaces with their blocks and slabs, and the motions they are asked about, for tests of what looks at all faces do.
#pragma once

#include <memory>

#include "narrowphase/block_slabs.hpp"
#include "patch_oracle.hpp"

namespace tegotae::test {

struct Blocks {
  explicit Blocks(const MeshPtr& of) : mesh(of), tree(of), blocks(tree), slabs(tree, blocks) {}

  Corners corners(std::uint32_t block, std::uint32_t k) const {
    const auto& t = mesh->triangles[blocks.face(block, k)];
    return {mesh->vertices[t[0]] - tree.origin(), mesh->vertices[t[1]] - tree.origin(),
            mesh->vertices[t[2]] - tree.origin()};
  }

  MeshPtr mesh;
  PatchTree tree;
  FaceBlocks blocks;
  BlockSlabs slabs;
};

/// A motion and where it brings a point.
struct Way {
  Placement start, end;

  Vec3 at(const Vec3& p, double s) const {
    const Vec3 from = start.R * p + start.t, to = end.R * p + end.t;
    return from + s * (to - from);
  }
};

}  // namespace tegotae::test
