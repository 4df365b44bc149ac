#pragma once

#include <cstdint>

#include "tegotae/core/clock.hpp"
#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"
#include "tegotae/lp/low_rank_matrix.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// The two tangents of a contact. row · z is how far its point slides along each (m).
struct TangentRows {
  /// One row for each of two directions, perpendicular to the normal and to each other; in the coordinates of the
  /// normal's row.
  Vec6 row[2];
};

/// Coulomb's law for one small motion z of a body that springs pull by `wanted`:
///   z = wanted + Σ N_iᵀ ν_i + T_iᵀ τ_i,   0 <= ν_i ⊥ N_i z - b_i >= 0,   |τ_i| <= μ_i ν_i,
/// and where a contact slides τ_i = -μ_i ν_i T_i z / |T_i z|. In these coordinates the springs' energy is half of the
/// squared length of what remains of `wanted`. Forces have the same unit (m); multiplied by the stiffness they are in
/// N.
struct FrictionProblem {
  const LowRankMatrix& normals;            ///< rows N_i
  const double* bounds;                    ///< b_i, m, at most 0, so that rest is allowed
  const TangentRows* tangents;             ///< T_i, one for each normal; read only where μ_i > 0
  const double* mu;                        ///< μ_i >= 0, one for each normal
  Vec6 wanted;                             ///< the motion that the springs ask for, m
  std::int64_t deadline_ns = kNoDeadline;  ///< time of monotonic_ns() after which an answer is of no use
};

/// Force of one contact, in the unit of its FrictionProblem.
struct FrictionForce {
  int row = 0;                    ///< index of the row in the problem
  double normal = 0;              ///< ν > 0
  double tangential[2] = {0, 0};  ///< τ along the two tangents
  bool slides = false;            ///< the point slides; false: it sticks, or there is no friction
};

}  // namespace tegotae
