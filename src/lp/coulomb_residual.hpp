#pragma once

#include <vector>

#include "tegotae/lp/friction_problem.hpp"

namespace tegotae {

/// How far z and `forces` are from the law: the largest of what the balance, the limits, the cones and the directions
/// are off by, m. Each contact is measured by the change that projecting its force on its cone would make.
double coulomb_residual(const FrictionProblem& problem, const Vec6& z,
                        const std::vector<FrictionForce>& forces) noexcept;

/// How far z falls short of the limit that it keeps least, m; at least 0.
double largest_shortfall(const LowRankMatrix& normals, const double* bounds, const Vec6& z) noexcept;

}  // namespace tegotae
