#pragma once

#include <algorithm>
#include <limits>

#include "narrowphase/free_cell.hpp"

namespace tegotae {

/// Lengths that were added up are rounded by less (relative, m, and rad).
inline constexpr double kSumSlack = 1e-9, kLengthSlack = 1e-11, kAngleSlack = 1e-14;
/// Normals are kept in single precision: a gap along one is no more than this part too long.
inline constexpr double kUnit = 1 - 1e-6;

/// The share of a motion during which a gap stays positive, as in share_of(); nothing where there is none at its start.
inline double share(double alpha, double beta, double bulge) {
  if (std::min(alpha, beta) >= bulge) return 1;
  return alpha > 0 ? share_of(alpha, beta, bulge) : 0;
}

}  // namespace tegotae
