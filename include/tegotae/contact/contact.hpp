#pragma once

#include "tegotae/core/export.hpp"
#include "tegotae/core/ids.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Contact::age of a limit that is no contact: a plane between two triangles, of use for one motion alone. Its gap is
/// not the distance of anything.
inline constexpr int kOneShotAge = -1;

/// A limit on the motion of the held part A: for a small displacement (dp, dr) of its center of mass the gap becomes
/// gap + n · (dp + dr × r). Taken at a free pose, so the gap is never negative.
struct Contact {
  Vec3 n;                  ///< n_BA_W: unit normal from the fixed part B to A, world
  Vec3 r;                  ///< from A's center of mass to the contact point on A, m, world
  double gap;              ///< m
  PartId part;             ///< B
  int age;                 ///< ticks this pair of features has been followed, or kOneShotAge
  Feature feature_a = {};  ///< of A's mesh
  Feature feature_b = {};  ///< of B's mesh; beside a concave edge the face on its other side
};

}  // namespace tegotae
