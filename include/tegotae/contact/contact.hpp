#pragma once

#include "tegotae/core/export.hpp"
#include "tegotae/core/ids.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Contact::age of a one-shot constraint. It is not a contact but a plane between two triangles, useful for one motion
/// only. Its gap is not a distance.
inline constexpr int kOneShotAge = -1;

/// Constraint on the motion of the held part A. After a small displacement (dp, dr) of A's center of mass the gap is
/// gap + n · (dp + dr × r). The loop takes constraints at a free pose, so the gap is not negative; only the resolver
/// "penalty" has negative gaps.
struct Contact {
  Vec3 n;                  ///< n_BA_W: unit normal from the fixed part B to A, world
  Vec3 r;                  ///< from A's center of mass to the contact point on A, m, world
  double gap;              ///< m
  PartId part;             ///< B
  int age;                 ///< number of ticks for which this pair of features has been tracked, or kOneShotAge
  Feature feature_a = {};  ///< of A's mesh
  Feature feature_b = {};  ///< of B's mesh; beside a concave edge the face on its other side
};

}  // namespace tegotae
