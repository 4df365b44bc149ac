#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "narrowphase/normal_cone.hpp"
#include "narrowphase/patch_tree.hpp"

namespace tegotae {

/// A surface that bounds a solid beyond doubt, and which way its faces look: closed, each edge of two faces that turn
/// the same way, no face without a normal, no two faces that meet but in what they share, every shell with its inside
/// inside, none within the box of another. For surfaces of up to kMostFaces triangles and kMostShells shells.
class Facing {
 public:
  static constexpr std::size_t kMostFaces = 1u << 21, kMostShells = 64;

  /// Null where the surface may not bound a solid.
  static std::shared_ptr<const Facing> of(const std::shared_ptr<const TriangleMesh>& mesh,
                                          const std::shared_ptr<const PatchTree>& tree);
  /// One point of each piece of a surface, whatever it bounds (m, file frame); none where there are more than
  /// kMostShells, or something belongs to no piece.
  static std::vector<Vec3> points_of(const std::shared_ptr<const TriangleMesh>& mesh);
  /// Of the hierarchy over parts that each bound a solid; their faces may meet. outside() is of the single parts.
  explicit Facing(std::shared_ptr<const PatchTree> tree);

  const PatchTree& tree() const { return *tree_; }
  const NormalCone& node(std::uint32_t i) const { return nodes_[i]; }
  const NormalCone& face(std::uint32_t i) const { return faces_[i]; }
  const std::vector<NormalCone>& faces() const { return faces_; }
  /// Whether `p` (m, file frame), which is on no face, is outside for sure. No allocation.
  bool outside(const Vec3& p) const noexcept;

 private:
  int windings(const Vec3& p, const Vec3& direction, bool& sure) const noexcept;

  std::shared_ptr<const PatchTree> tree_;
  std::vector<NormalCone> nodes_, faces_;
};

}  // namespace tegotae
