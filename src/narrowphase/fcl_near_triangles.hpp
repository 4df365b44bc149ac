#pragma once

#include <atomic>
#include <memory>

#include "narrowphase/near_front.hpp"

namespace tegotae {

/// Whether a surface A that moves past a surface B intersects it: FCL's word on each pair of triangles that boxes do
/// not keep farther apart than kNear. Knows nothing of the certificate of motions. Mutable scratch of one thread.
class FclNearTriangles {
 public:
  /// Triangles that are this much (m) apart are none of FCL's business; those that touch count as intersecting.
  static constexpr double kNear = 1e-7;

  FclNearTriangles(std::shared_ptr<const PatchTree> a, std::shared_ptr<const PatchTree> b)
      : front_(std::move(a), std::move(b)) {}

  /// Whether any triangles intersect with A's file frame at `X_BA` in B's; stops at the first. Poses along a path, in
  /// order, are asked fastest. A question is broken off when `stop` (may be null) becomes true: then false means
  /// nothing.
  bool intersect(const Pose& X_BA, const std::atomic<bool>* stop = nullptr);

 private:
  NearFront front_;
};

}  // namespace tegotae
