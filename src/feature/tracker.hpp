#pragma once

#include "feature/feature.hpp"

namespace tegotae {

/// Two features with their closest points, in B's file frame.
struct FeaturePair {
  Feature a, b;             ///< of the held part A and of the fixed part B
  Vec3 p_a = Vec3::Zero();  ///< closest point on `a`
  Vec3 p_b = Vec3::Zero();  ///< closest point on `b`
  double distance = 0;      ///< m
  bool ended = true;        ///< at a minimum; false when the walk had made all its moves before it came to one
};

/// How far a neighboring feature may lean towards the other part (rad) before a walk follows it. Zero finds strict
/// local minima only: of a box that hovers 0.001 rad tilted over a floor just the lowest corner, and the box then tips
/// from corner to corner. Too large keeps features that are not a minimum of distance.
struct WalkTolerance {
  double vertex = 0.03;  ///< from a vertex to one of its edges
  double edge = 0.01;    ///< from an edge to one of its faces
};

/// Walks from the features `a`, `b` over adjacent features down to a local minimum of their distance (Lin and Canny, "A
/// fast algorithm for incremental distance calculation", 1991, on surfaces that need not be convex): as long as the
/// closest point lies outside the Voronoi region of its feature, the neighbor on whose side it lies takes over. Each
/// move shortens the distance, so the walk ends; it also ends, where it is, after `most` moves (FeaturePair::ended).
/// Between closed convex bodies the minimum is their distance, if the walk starts on sides that face each other (a face
/// seen from behind, through the solid, is a minimum of its own).
FeaturePair walk_to_minimum(const Surface& A, const Surface& B, const Pose& X_BA, Feature a, Feature b,
                            const WalkTolerance& tolerance = {}, int most = 64);

}  // namespace tegotae
