#pragma once

#include <limits>

#include "lp/row_workspace.hpp"
#include "lp/solution.hpp"
#include "lp/span_basis.hpp"
#include "tegotae/lp/low_rank_matrix.hpp"

namespace tegotae {

/// Outcome of minimize ½|z - z0|² subject to G z >= b. Residuals belong to the data as given, nothing scaled.
struct QpResult {
  LpStatus status = LpStatus::stalled;
  Vec6 z = Vec6::Zero();       ///< the minimizer; z0 unless optimal
  double objective = 0;        ///< ½|z - z0|²
  double primal_residual = 0;  ///< largest b_i - g_i·z above zero, in the unit of b
  double dual_residual = 0;    ///< |z - z0 - Gᵀλ|
  double complementarity = 0;  ///< largest |λ_i (g_i·z - b_i)|
  int iterations = 0;          ///< constraints added and dropped
  SparseRows multipliers;  ///< optimal: λ >= 0 (at most 6). infeasible: y >= 0, Gᵀy ≈ 0, (b - G z0)ᵀy > 0. Else empty
  /// Infeasible only: every z with G z >= b is farther than this from z0 ((b - G z0)ᵀy / |Gᵀy|).
  double reach = std::numeric_limits<double>::infinity();
};

/// Gauss's least constraint as a projection in six dimensions: the dual active-set method of Goldfarb and Idnani
/// ("A numerically stable dual method for solving strictly convex quadratic programs", 1983) with the identity as
/// Hessian. At most six rows are active; an iteration costs one pass over the rows. Deterministic: the same input gives
/// the same bits on every CPU. `solve` allocates nothing.
class LeastDistanceSolver {
 public:
  /// For at most `capacity` rows.
  explicit LeastDistanceSolver(int capacity) : rows_(capacity) {}

  /// `b` has g.rows() entries. `warm` names rows that were active last time (any rows do; the first six independent
  /// ones are used): the answer is the same, the iterations fewer. Non-finite input, too many rows: `stalled`.
  const QpResult& solve(const LowRankMatrix& g, const double* b, const Vec6& z0, const int* warm = nullptr,
                        int warm_count = 0) noexcept;

 private:
  /// Makes `row` active; false when it depends on the active rows.
  bool append(int row) noexcept;
  void drop(int position) noexcept;
  void solve_active() noexcept;
  /// Raises the multiplier of a violated row until the row is satisfied. Drops active rows, at most six, whose
  /// multiplier runs out on the way. False: the solve ends with result_ as it is.
  bool raise(const RowChoice& violated) noexcept;
  /// The same for a row that depends on the active ones with the factors `along`, none of which can be dropped.
  bool leave_dependent(const RowChoice& violated, const double* along) noexcept;
  void start_from(const int* warm, int warm_count) noexcept;
  bool certify_infeasible(int row, const double* along) noexcept;
  void finish(const double* b, const Vec6& z0) noexcept;

  RowWorkspace rows_;
  const LowRankMatrix* g_ = nullptr;
  int size_ = 0;           ///< active rows
  int active_[6] = {};     ///< which
  SpanBasis span_;         ///< of their unit rows
  double lambda_[6] = {};  ///< multipliers times the row length
  Vec6 x_ = Vec6::Zero();  ///< z - z0
  QpResult result_;
};

}  // namespace tegotae
