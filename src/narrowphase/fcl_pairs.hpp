#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "tegotae/core/pose.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

/// FCL between any two meshes of a scene, outside of the loop; hierarchies are built when first needed.
class FclPairs {
 public:
  using Faces = std::pair<std::uint32_t, std::uint32_t>;  ///< of A and of B

  FclPairs();
  ~FclPairs();
  FclPairs(const FclPairs&) = delete;
  FclPairs& operator=(const FclPairs&) = delete;

  /// The intersecting triangle pairs of `a` at `X_BA` (A in B's file frame) with `b`, at most `most` of them. Triangles
  /// that touch count.
  std::vector<Faces> intersections(const TriangleMesh& a, const TriangleMesh& b, const Pose& X_BA, std::size_t most);
  /// Whether any do; stops at the first.
  bool intersect(const TriangleMesh& a, const TriangleMesh& b, const Pose& X_BA);
  /// The distance (m) of surfaces that do not intersect, if it is less than `bound`, else `bound`; `nearest` is set
  /// when it is less.
  double distance_below(double bound, const TriangleMesh& a, const TriangleMesh& b, const Pose& X_BA, Faces& nearest);

 private:
  struct Models;
  std::unique_ptr<Models> models_;
};

}  // namespace tegotae
