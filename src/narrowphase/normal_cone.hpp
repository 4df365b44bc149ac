#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "narrowphase/patch_tree.hpp"

namespace tegotae {

/// Which way a surface faces: all unit normals within an angle of an axis (file frame). No cone: `cos` is -1.
struct NormalCone {
  std::array<float, 3> axis{};
  float cos = -1, sin = 0;  ///< of the angle, rounded outwards

  /// Around normals whose cosines with `axis`, of unit length, are `least` or more. None where that is too wide.
  static NormalCone about(const Vec3& axis, double least);
  /// Around those of some faces; none where one of them has none.
  static NormalCone around(const std::vector<NormalCone>& of_faces, const std::vector<std::uint32_t>& faces);

  /// The other side of the same surface.
  NormalCone turned() const { return {{-axis[0], -axis[1], -axis[2]}, cos, sin}; }
  /// Least of n · v over the normals; very low where there is no cone.
  double least(const Vec3& v) const;
};

/// The unit normal of a face; zero where it is too thin to have one.
Vec3 normal_of(const PatchTree& tree, std::uint32_t face);

}  // namespace tegotae
