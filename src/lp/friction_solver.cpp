#include "lp/friction_solver.hpp"

#include <algorithm>

namespace tegotae {
namespace {

/// A residual below this part of the wanted motion is the law.
constexpr double kExact = 1e-7;

}  // namespace

FrictionSolver::FrictionSolver(int capacity) : frictionless_(capacity), active_set_(capacity), cone_(capacity) {
  result_.forces.reserve(static_cast<std::size_t>(std::max(FrictionActiveSet::most_forces(), SparseRows::kMax)));
}

void FrictionSolver::take_frictionless(const QpResult& qp) noexcept {
  result_.status = qp.status;
  result_.iterations = qp.iterations;
  result_.method = FrictionMethod::frictionless;
  result_.exact = qp.status == LpStatus::optimal;
  result_.residual = 0;
  result_.z.setZero();
  result_.forces.clear();
  if (!result_.exact) return;
  result_.z = qp.z;
  for (int k = 0; k < qp.multipliers.count; ++k) {
    FrictionForce f;
    f.row = qp.multipliers.index[static_cast<std::size_t>(k)];
    f.normal = qp.multipliers.value[static_cast<std::size_t>(k)];
    result_.forces.push_back(f);
  }
}

bool FrictionSolver::try_active_set(const FrictionProblem& problem, const Vec6& from, FrictionActiveSet::Start start,
                                    FrictionMethod method) noexcept {
  const bool ended = active_set_.solve(problem, from, start);
  result_.iterations += active_set_.rounds();
  if (!ended) return false;
  result_.forces.clear();
  active_set_.forces(result_.forces);
  result_.residual = coulomb_residual(problem, active_set_.z(), result_.forces);
  if (!(result_.residual <= kExact * problem.wanted.norm())) return false;
  result_.z = active_set_.z();
  result_.method = method;
  result_.exact = true;
  return true;
}

void FrictionSolver::relax(const FrictionProblem& problem) noexcept {
  result_.method = FrictionMethod::relaxed;
  result_.z.setZero();
  result_.forces.clear();
  const bool solved = cone_.solve(problem);
  result_.iterations += cone_.changes();
  // Standing still is always allowed.
  if (solved) {
    result_.z = cone_.z();
    cone_.forces(result_.forces);
  }
  result_.residual = coulomb_residual(problem, result_.z, result_.forces);
  result_.exact = result_.residual <= kExact * problem.wanted.norm();
}

const FrictionResult& FrictionSolver::solve(const FrictionProblem& problem) noexcept {
  const QpResult& qp = frictionless_.solve(problem.normals, problem.bounds, problem.wanted);
  take_frictionless(qp);
  if (qp.status != LpStatus::optimal) return result_;
  const bool rubs = std::any_of(result_.forces.begin(), result_.forces.end(),
                                [&](const FrictionForce& f) { return problem.mu[f.row] > 0; });
  if (!rubs) return result_;
  const Vec6 from = qp.z;
  if (try_active_set(problem, from, FrictionActiveSet::Start::along, FrictionMethod::sliding)) return result_;
  if (try_active_set(problem, from, FrictionActiveSet::Start::stick, FrictionMethod::sticking)) return result_;
  relax(problem);
  return result_;
}

}  // namespace tegotae
