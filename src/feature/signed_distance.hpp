#pragma once

#include <memory>
#include <vector>

#include "feature/nearest_face.hpp"

namespace tegotae {

/// Where a point stands to a surface; file frame of the surface, m.
struct SurfacePoint {
  double distance = 0;         ///< to the nearest point of the surface, negative inside
  Vec3 point = Vec3::Zero();   ///< that nearest point
  Vec3 normal = Vec3::Zero();  ///< unit, outward: along the distance, at the surface itself that of the feature
  std::uint32_t face = 0;      ///< one that has the nearest point
};

/// Signed distance of points to a closed surface. The sign comes from the angle-weighted normal of the nearest feature
/// (Bærentzen and Aanæs, "Signed distance computation using the angle weighted pseudonormal", 2005). Of an open surface
/// points count as outside where the rim is nearest, and elsewhere as inside on the back of its faces.
class SignedDistance {
 public:
  /// Throws Error for a hierarchy of absurd depth.
  SignedDistance(std::shared_ptr<const Surface> surface, std::shared_ptr<const PatchTree> tree);

  /// `hint` is a face that may be near (any will do). O(log triangles); never allocates.
  SurfacePoint at(const Vec3& p, std::uint32_t hint) const noexcept;
  const Surface& surface() const { return *surface_; }

 private:
  Vec3 feature_normal(const NearFace& best, bool& rim) const;

  std::shared_ptr<const Surface> surface_;
  NearestFace nearest_;
  std::vector<Vec3> vertex_normals_;  ///< angle-weighted, not of unit length
  std::vector<std::uint8_t> vertex_rim_;
};

}  // namespace tegotae
