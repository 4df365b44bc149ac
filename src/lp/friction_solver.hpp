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
  refined,       ///< exact, from the convex neighbor's answer or from the guess
  relaxed,       ///< of the last convex neighbor that keeps the bounds: exact (see `exact`) where nothing slides
  late           ///< the deadline passed: the guess as it was, or without one no answer
};

/// Outcome of a friction problem.
struct FrictionResult {
  LpStatus status = LpStatus::stalled;  ///< optimal; that of the problem without friction; stalled when late
  Vec6 z = Vec6::Zero();                ///< zero unless optimal
  FrictionMethod method = FrictionMethod::frictionless;
  bool exact = false;                 ///< Coulomb's law holds to 1e-7 of the wanted motion
  double residual = 0;                ///< coulomb_residual(), m; of an exact frictionless answer 0
  int iterations = 0;                 ///< changes and rounds of all methods
  std::vector<FrictionForce> forces;  ///< that are not zero
};

/// Coulomb friction for a body with six degrees of freedom, without a memory: sticking is z = 0. Of several motions
/// that obey the law it takes the one that is reached from the frictionless motion, so that a part that could be wedged
/// but need not be is not. `solve` allocates nothing; its time is bounded by its rounds, and by the problem's deadline,
/// which it looks at between two of them.
class FrictionSolver {
 public:
  /// For at most `capacity` rows.
  explicit FrictionSolver(int capacity);
  /// `guess`: forces that hold the body where it is, if they are known; the law is looked for near them first.
  const FrictionResult& solve(const FrictionProblem& problem, const std::vector<FrictionForce>& guess = {}) noexcept;

 private:
  void take_frictionless(const QpResult& qp) noexcept;
  /// Takes what the active set ended at, if it obeys the law.
  bool take_active_set(const FrictionProblem& problem, FrictionMethod method) noexcept;
  bool refine(const FrictionProblem& problem, const Vec6& from, const std::vector<FrictionForce>& forces) noexcept;
  /// Sets estimate_ to the frictionless forces, each with the friction of its slip.
  void estimate_sliding(const FrictionProblem& problem, const QpResult& qp) noexcept;
  /// From the convex neighbor, whose forces are near estimate_, on towards the law; false when it does not come there.
  bool shift(const FrictionProblem& problem) noexcept;
  /// Keeps the convex neighbor's answer for take_nearest() if it keeps the problem's bounds.
  void keep_nearest(const FrictionProblem& problem) noexcept;
  /// Takes the last answer that was kept, or standing still.
  void take_nearest(const FrictionProblem& problem) noexcept;
  /// What there is when time is up: those forces of the guess whose contacts touch, and the motion that is left with
  /// them; without a guess no answer.
  const FrictionResult& end_late(const FrictionProblem& problem, const std::vector<FrictionForce>& guess) noexcept;

  LeastDistanceSolver frictionless_;
  FrictionActiveSet active_set_;
  RelaxedCone cone_;
  std::vector<double> shifted_;  // bounds
  std::vector<FrictionForce> estimate_;
  Vec6 nearest_z_ = Vec6::Zero();  // see keep_nearest()
  std::vector<FrictionForce> nearest_;
  FrictionResult result_;
};

}  // namespace tegotae
