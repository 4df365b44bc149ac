#pragma once

#include <memory>
#include <vector>

#include "narrowphase/face_pair.hpp"
#include "tegotae/core/pose.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

/// Triangle intersection by FCL (V-Collide's role in the paper). Triangles that touch count as intersecting.
class FclNarrowPhase {
 public:
  /// `fixed` in the order of their part numbers; hierarchies are built once for each distinct mesh.
  FclNarrowPhase(const TriangleMesh& held, const std::vector<const TriangleMesh*>& fixed);
  ~FclNarrowPhase();
  FclNarrowPhase(const FclNarrowPhase&) = delete;
  FclNarrowPhase& operator=(const FclNarrowPhase&) = delete;

  /// Appends the intersecting triangle pairs of the held part at `X_BA` (A in B's file frame) with fixed part `part` to
  /// `pairs`, at most `most` of them; returns how many were appended.
  int intersections(std::uint32_t part, const Pose& X_BA, int most, std::vector<FacePair>& pairs);
  /// Whether any pair intersects.
  bool intersects(std::uint32_t part, const Pose& X_BA);
  /// The distance of the nearest pair if it is less than `bound` (m), else `bound`; for parts that do not intersect.
  /// `nearest` is set when it is less.
  double distance_below(double bound, std::uint32_t part, const Pose& X_BA, FacePair& nearest);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tegotae
