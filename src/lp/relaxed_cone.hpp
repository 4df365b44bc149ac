#pragma once

#include <vector>

#include "lp/coulomb_residual.hpp"
#include "lp/pricing.hpp"
#include "lp/span_basis.hpp"

namespace tegotae {

/// The convex neighbor of a friction problem: the motion nearest to the wanted one with N_i z - μ_i |T_i z| >= b_i. It
/// always has an answer, which is Coulomb's wherever nothing slides; a contact that slides opens meanwhile. Goldfarb
/// and Idnani's method with a row made for each contact where it is needed. `solve` allocates nothing.
class RelaxedCone {
 public:
  /// For at most `capacity` rows; allocates.
  explicit RelaxedCone(int capacity);

  /// Takes the problem, which must live until the last solve of it.
  void set_problem(const FrictionProblem& problem) noexcept;
  /// Limits hold to `tolerance` of the wanted motion, with the problem's bounds or others (one for each row). False
  /// when precision is lost, which leaves standing still, or the problem's time is up. `start`: forces that are near
  /// those of the answer, or none.
  bool solve(const double* bounds, double tolerance, const std::vector<FrictionForce>& start = {}) noexcept;

  // Of the last solve that succeeded:
  const Vec6& z() const noexcept { return z_; }
  /// Appends the forces, at most six.
  void forces(std::vector<FrictionForce>& out) const noexcept;
  int changes() const noexcept { return changes_; }

 private:
  struct Row {
    Vec6 unit;
    double target = 0;  ///< along `unit`, from the wanted motion on
    double length = 0;
    double direction[2] = {0, 0};
    int contact = 0;
  };

  /// Takes rows of contacts with force, those whose multipliers do not come out negative together.
  void start_from(const std::vector<FrictionForce>& forces) noexcept;
  /// The row that z_ violates most, by more than `tolerance`.
  bool most_violated(double tolerance, Row& out) noexcept;
  void make_row(int contact, Row& out) const noexcept;
  /// Sets the rest of a row whose contact and direction are set.
  void complete(Row& row) const noexcept;
  void set_bounds(const double* bounds) noexcept;
  /// Raises the row's multiplier until it holds; false when it cannot.
  bool take(const Row& row) noexcept;
  void drop(int position) noexcept;
  void solve_active() noexcept;

  const Pricing& pricing_;
  const FrictionProblem* problem_ = nullptr;
  const double* bounds_ = nullptr;
  LowRankMatrix friction_[2];     ///< tangents times μ
  std::vector<LaneBlock> lanes_;  ///< the bounds
  SpanBasis span_;
  Row rows_[6];
  double lambda_[6] = {};
  int size_ = 0;
  Vec6 z_ = Vec6::Zero();
  int changes_ = 0;
};

}  // namespace tegotae
