#pragma once

#include <vector>

#include "lp/friction_active_set.hpp"
#include "lp/least_distance.hpp"
#include "lp/relaxed_cone.hpp"

namespace tegotae {

/// How the answer of a friction problem was found.
enum class FrictionMethod {
  frictionless,  ///< no contact with friction carries force
  sliding,       ///< exact, from the frictionless motion
  sticking,      ///< exact, from all contacts sticking, where the way from the frictionless motion did not end
  relaxed        ///< of the convex neighbor: exact (see `exact`) where nothing slides
};

/// Outcome of a friction problem.
struct FrictionResult {
  LpStatus status = LpStatus::stalled;  ///< optimal; or that of the problem without friction
  Vec6 z = Vec6::Zero();                ///< zero unless optimal
  FrictionMethod method = FrictionMethod::frictionless;
  bool exact = false;                 ///< Coulomb's law holds to 1e-7 of the wanted motion
  double residual = 0;                ///< coulomb_residual(), m; of an exact frictionless answer 0
  int iterations = 0;                 ///< changes and rounds of all methods
  std::vector<FrictionForce> forces;  ///< that are not zero
};

/// Coulomb friction for a body with six degrees of freedom, without a memory: sticking is z = 0. Of several motions
/// that obey the law it takes the one that is reached from the frictionless motion, so that a part that could be wedged
/// but need not be is not. `solve` allocates nothing; its time is bounded by its rounds.
class FrictionSolver {
 public:
  /// For at most `capacity` rows.
  explicit FrictionSolver(int capacity);
  const FrictionResult& solve(const FrictionProblem& problem) noexcept;

 private:
  void take_frictionless(const QpResult& qp) noexcept;
  bool try_active_set(const FrictionProblem& problem, const Vec6& from, FrictionActiveSet::Start start,
                      FrictionMethod method) noexcept;
  void relax(const FrictionProblem& problem) noexcept;

  LeastDistanceSolver frictionless_;
  FrictionActiveSet active_set_;
  RelaxedCone cone_;
  FrictionResult result_;
};

}  // namespace tegotae
