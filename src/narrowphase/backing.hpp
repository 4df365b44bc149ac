#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "narrowphase/face_columns.hpp"
#include "narrowphase/facing.hpp"
#include "narrowphase/normal_cone.hpp"
#include "narrowphase/patch_tree.hpp"

namespace tegotae {

/// What lies behind a surface that looks along one axis nearly everywhere, such as an open sheet or a thin shell: each
/// face that does is drawn out by a depth to one side, and what they sweep is taken to be solid. It is bounded by the
/// faces, looking away from where they were drawn, by walls under their rims, and by the faces once more, moved by the
/// depth. So a sheet that moves to that side recedes from all that it leaves, as a solid does (see PassingPoints). Any
/// orientation of the faces will do, and any manifold. File frame of the surface. Immutable.
class Backing {
 public:
  /// To which side of the axis the faces are drawn.
  enum class Side : std::uint8_t { plus, minus };

  /// Null where the surface looks in other directions too, where it has too many rims, and where it bounds a solid that
  /// is no shell: `facing` tells of that, and is null if it bounds none.
  static std::shared_ptr<const Backing> of(const std::shared_ptr<const PatchTree>& tree, const Facing* facing);

  /// The faces and walls are drawn out by this, m.
  Vec3 drawn(Side side) const { return side == Side::plus ? out_ : Vec3(-out_); }
  /// Null where there are none.
  const std::shared_ptr<const PatchTree>& walls(Side side) const { return walls_[static_cast<std::size_t>(side)]; }
  /// Of each face, looking along the axis; none where the face is not drawn out.
  const std::vector<NormalCone>& faces() const { return faces_; }
  /// Whether `p` (m), which is on no face, is for sure outside what was drawn to that side. No allocation.
  bool outside(const Vec3& p, Side side) const noexcept;

 private:
  explicit Backing(std::shared_ptr<const PatchTree> tree) : tree_(std::move(tree)) {}

  std::shared_ptr<const PatchTree> tree_;
  Vec3 out_ = Vec3::Zero();  ///< along the axis, as long as the depth
  std::vector<NormalCone> faces_;
  FaceColumns columns_;  ///< those that are drawn out, along the axis
  std::array<std::shared_ptr<const PatchTree>, 2> walls_;
};

}  // namespace tegotae
