#include "lp/friction_solver.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

/// A residual below this part of the wanted motion is the law.
constexpr double kExact = 1e-7;
/// Convex neighbors solved one after the other; most that come to the law do so with the first.
struct Shift {
  double tolerance;  ///< of the wanted motion; a coarse one tells as well who sticks and who slides
  double further;    ///< the next bounds go so many times as far on as the slip has grown
};
constexpr std::array<Shift, 4> kShifts = {{{1e-7, 1}, {1e-9, 4}, {1e-10, 0}, {1e-10, 0}}};

}  // namespace

FrictionSolver::FrictionSolver(int capacity)
    : frictionless_(capacity), active_set_(capacity), cone_(capacity), shifted_(static_cast<std::size_t>(capacity)) {
  const auto most = static_cast<std::size_t>(std::max(FrictionActiveSet::most_forces(), SparseRows::kMax));
  result_.forces.reserve(most);
  estimate_.reserve(most);
  nearest_.reserve(most);
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

bool FrictionSolver::refine(const FrictionProblem& problem, const Vec6& from,
                            const std::vector<FrictionForce>& forces) noexcept {
  const bool ended = active_set_.refine(problem, from, forces);
  result_.iterations += active_set_.rounds();
  return ended && take_active_set(problem, FrictionMethod::refined);
}

bool FrictionSolver::take_active_set(const FrictionProblem& problem, FrictionMethod method) noexcept {
  result_.forces.clear();
  active_set_.forces(result_.forces);
  result_.residual = coulomb_residual(problem, active_set_.z(), result_.forces);
  if (!(result_.residual <= kExact * problem.wanted.norm())) return false;
  result_.z = active_set_.z();
  result_.method = method;
  result_.exact = true;
  return true;
}

void FrictionSolver::estimate_sliding(const FrictionProblem& problem, const QpResult& qp) noexcept {
  estimate_.clear();
  for (int k = 0; k < qp.multipliers.count; ++k) {
    FrictionForce f;
    f.row = qp.multipliers.index[static_cast<std::size_t>(k)];
    f.normal = qp.multipliers.value[static_cast<std::size_t>(k)];
    estimate_.push_back(f);
    const double most = problem.mu[f.row] * f.normal;
    if (!(most > 0)) continue;
    const TangentRows& t = problem.tangents[f.row];
    const double s0 = t.row[0].dot(qp.z), s1 = t.row[1].dot(qp.z), slip = std::sqrt(s0 * s0 + s1 * s1);
    if (!(slip > 0)) continue;
    estimate_.back().tangential[0] = -most * s0 / slip;
    estimate_.back().tangential[1] = -most * s1 / slip;
  }
}

bool FrictionSolver::shift(const FrictionProblem& problem) noexcept {
  // Where a contact slides by s, the convex neighbor opens its gap by mu s. With bounds that are lower by that of the
  // last answer the next opens less: its fixed point is the law (Acary, Cadoux, Lemaréchal, Malick, ZAMM 2011, after De
  // Saxcé's bipotential). Which contacts stick, slide and where to is right long before the numbers are. In a hole with
  // play each step brings slip of a play over mu, so that the bounds go ahead of a slip that grows.
  nearest_z_.setZero();
  nearest_.clear();
  std::copy_n(problem.bounds, problem.normals.rows(), shifted_.begin());
  for (const Shift& shift : kShifts) {
    const bool solved = cone_.solve(shifted_.data(), shift.tolerance, estimate_);
    result_.iterations += cone_.changes();
    if (!solved) return false;
    estimate_.clear();
    cone_.forces(estimate_);
    keep_nearest(problem);
    if (refine(problem, cone_.z(), estimate_)) return true;
    if (past(problem.deadline_ns)) return false;
    for (int i = 0; i < problem.normals.rows(); ++i) {
      if (!(problem.mu[i] > 0)) continue;
      const TangentRows& t = problem.tangents[i];
      const double s0 = t.row[0].dot(cone_.z()), s1 = t.row[1].dot(cone_.z());
      const double opened = problem.mu[i] * std::sqrt(s0 * s0 + s1 * s1);
      double& bound = shifted_[static_cast<std::size_t>(i)];
      const double grown = std::max(0.0, opened - (problem.bounds[i] - bound));
      bound = problem.bounds[i] - opened - shift.further * grown;
    }
  }
  return false;
}

void FrictionSolver::keep_nearest(const FrictionProblem& problem) noexcept {
  if (largest_shortfall(problem.normals, problem.bounds, cone_.z()) > kExact * problem.wanted.norm()) return;
  nearest_z_ = cone_.z();
  nearest_.assign(estimate_.begin(), estimate_.end());
}

void FrictionSolver::take_nearest(const FrictionProblem& problem) noexcept {
  result_.method = FrictionMethod::relaxed;
  result_.z = nearest_z_;
  result_.forces.assign(nearest_.begin(), nearest_.end());
  result_.residual = coulomb_residual(problem, result_.z, result_.forces);
  result_.exact = result_.residual <= kExact * problem.wanted.norm();
}

const FrictionResult& FrictionSolver::end_late(const FrictionProblem& problem,
                                               const std::vector<FrictionForce>& guess) noexcept {
  result_.status = guess.empty() ? LpStatus::stalled : LpStatus::optimal;
  result_.method = FrictionMethod::late;
  result_.exact = false;
  result_.forces.clear();
  result_.z = guess.empty() ? Vec6(Vec6::Zero()) : problem.wanted;
  for (const FrictionForce& f : guess) {
    if (problem.bounds[f.row] < 0) continue;
    result_.forces.push_back(f);
    result_.z += f.normal * problem.normals.row(f.row);
    if (!(problem.mu[f.row] > 0)) continue;
    const TangentRows& t = problem.tangents[f.row];
    result_.z += f.tangential[0] * t.row[0] + f.tangential[1] * t.row[1];
  }
  result_.residual = coulomb_residual(problem, result_.z, result_.forces);
  return result_;
}

const FrictionResult& FrictionSolver::solve(const FrictionProblem& problem,
                                            const std::vector<FrictionForce>& guess) noexcept {
  if (!guess.empty()) {
    result_.status = LpStatus::optimal;
    result_.iterations = 0;
    if (refine(problem, Vec6::Zero(), guess)) return result_;
    // What held the part a moment ago was reached from the frictionless motion; its neighborhood is looked at first.
    cone_.set_problem(problem);
    estimate_.assign(guess.begin(), guess.end());
    if (shift(problem)) return result_;
    if (past(problem.deadline_ns)) return end_late(problem, guess);
  }
  const QpResult& qp = frictionless_.solve(problem.normals, problem.bounds, problem.wanted);
  take_frictionless(qp);
  if (qp.status != LpStatus::optimal) return result_;
  const bool rubs = std::any_of(result_.forces.begin(), result_.forces.end(),
                                [&](const FrictionForce& f) { return problem.mu[f.row] > 0; });
  if (!rubs) return result_;
  const Vec6 from = qp.z;
  const bool ended = active_set_.solve(problem, from);
  result_.iterations += active_set_.rounds();
  if (ended && take_active_set(problem, FrictionMethod::sliding)) return result_;
  if (past(problem.deadline_ns)) return end_late(problem, guess);
  // After a guess the convex neighbors have been tried already.
  if (guess.empty()) {
    cone_.set_problem(problem);
    estimate_sliding(problem, qp);
    if (shift(problem)) return result_;
    if (past(problem.deadline_ns)) return end_late(problem, guess);
  }
  take_nearest(problem);
  return result_;
}

}  // namespace tegotae
