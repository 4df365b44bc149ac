#pragma once

#include <memory>
#include <vector>

#include "narrowphase/near_front.hpp"

namespace tegotae {

/// The nearest points of two surfaces.
struct NearestPoints {
  double distance = 0;                            ///< m; 0 when the surfaces intersect
  Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();  ///< m, B's file frame; where they intersect: a place near by
};

/// Distance of a surface A that moves past a surface B, from all of their triangles, to within NearFront::kTolerance.
/// The nearest triangles of the last pose bound what has to be looked at. Mutable scratch of one thread; allocates.
class SurfaceDistance {
 public:
  SurfaceDistance(std::shared_ptr<const PatchTree> a, std::shared_ptr<const PatchTree> b) : front_(a, b) {}

  /// Whether the surfaces are at most `limit` (m) apart with A's file frame at `X_BA` in B's; `out` is set when they
  /// are. Poses along a path, in order, are asked fastest.
  bool within(double limit, const Pose& X_BA, NearestPoints& out);

 private:
  class Query;
  NearFront front_;
  std::uint32_t face_a_ = 0, face_b_ = 0;  // nearest when it was last asked
};

}  // namespace tegotae
