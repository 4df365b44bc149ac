#pragma once

#include <memory>

#include "mesh/surface.hpp"
#include "narrowphase/patch_tree.hpp"

namespace tegotae {

/// How far points are from a surface, and on which side.
class SignedDistance {
 public:
  explicit SignedDistance(const std::shared_ptr<const TriangleMesh>& mesh);

  /// Distance (m) of `p` (file frame) from the nearest point of the surface, negative inside. Only a closed surface
  /// that does not cross itself has an inside; the side is that of the angle-weighted normal at the nearest vertex, edge
  /// or face (Bærentzen and Aanæs, "Signed distance computation using the angle weighted pseudonormal", 2005).
  double at(const Vec3& p) const;

  const Surface& surface() const { return surface_; }
  bool closed() const { return closed_; }

 private:
  PatchTree tree_;
  Surface surface_;
  bool closed_;
};

}  // namespace tegotae
