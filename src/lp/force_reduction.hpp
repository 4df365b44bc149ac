#pragma once

#include <vector>

#include "lp/coulomb_residual.hpp"

namespace tegotae {

/// Takes forces out of `forces` and scales the rest, until at most six are left with the same sum (Carathéodory). Each
/// that stays keeps its direction, so it stays in its cone.
void reduce_to_six(const FrictionProblem& problem, std::vector<FrictionForce>& forces) noexcept;

}  // namespace tegotae
