#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

/// Most triangles in a leaf of a PatchTree.
inline constexpr std::uint32_t kPatchLeaf = 2;

/// A convex piece of space around some triangles: { origin + center + Σ tᵢ half[i] axis[i], |tᵢ| ≤ 1 }, where `origin`
/// is PatchTree::origin() and all lengths are in m. The axes are unit vectors up to rounding; the set above, taken with
/// the stored numbers, holds every triangle of the node.
struct PatchNode {
  std::array<float, 3> center;
  std::array<std::array<float, 3>, 3> axis;
  std::array<float, 3> half;  ///< longest first: half[2] is half the thickness
  std::uint32_t first;  ///< inner node: first child (the second follows it); leaf: first place in PatchTree::order()
  std::uint32_t count;  ///< triangles of a leaf, 0 for an inner node

  bool leaf() const { return count > 0; }
  Vec3 center_vec() const { return {double{center[0]}, double{center[1]}, double{center[2]}}; }
  Vec3 axis_vec(int i) const { return {double{axis[i][0]}, double{axis[i][1]}, double{axis[i][2]}}; }
};

/// Immutable hierarchy of flat patches over a triangle surface, in the mesh's file frame. Works for any surface: open,
/// non-manifold, triangle soup, degenerate and repeated faces.
///
/// Built from the bottom (see patch_clusters.hpp): a patch of a curved wall is as wide as its sagitta allows and as
/// long as the wall is straight. Boxes are fitted to the patch's own normal and outline.
class PatchTree {
 public:
  /// Builds the hierarchy; about 2 µs a triangle. A mesh without triangles throws Error.
  explicit PatchTree(std::shared_ptr<const TriangleMesh> mesh);
  /// The hierarchy that an earlier build over the same mesh made (see patch_cache.hpp).
  PatchTree(std::shared_ptr<const TriangleMesh> mesh, std::vector<PatchNode> nodes, std::vector<std::uint32_t> order,
            const Vec3& origin, double radius)
      : mesh_(std::move(mesh)), nodes_(std::move(nodes)), order_(std::move(order)), origin_(origin), radius_(radius) {}

  const TriangleMesh& mesh() const { return *mesh_; }
  const std::vector<PatchNode>& nodes() const { return nodes_; }      ///< [0] is the root
  const std::vector<std::uint32_t>& order() const { return order_; }  ///< faces, leaf after leaf
  const Vec3& origin() const { return origin_; }                      ///< m, file frame
  /// Largest distance of a triangle from `origin()`, m.
  double radius() const { return radius_; }
  /// The box of one face, as if it were a leaf of its own.
  PatchNode face_box(std::uint32_t face) const;
  std::size_t bytes() const;  ///< memory of the hierarchy without the mesh

  /// Corner `k` of `face`, m, file frame.
  const Vec3& corner(std::uint32_t face, int k) const { return mesh_->vertices[mesh_->triangles[face][k]]; }

 private:
  std::shared_ptr<const TriangleMesh> mesh_;
  std::vector<PatchNode> nodes_;
  std::vector<std::uint32_t> order_;
  Vec3 origin_ = Vec3::Zero();
  double radius_ = 0;
};

}  // namespace tegotae
