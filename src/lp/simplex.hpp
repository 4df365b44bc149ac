#pragma once

#include <limits>

#include "lp/row_workspace.hpp"
#include "lp/small_lu.hpp"
#include "lp/solution.hpp"
#include "lp/span_basis.hpp"
#include "tegotae/lp/low_rank_matrix.hpp"

namespace tegotae {

/// Outcome of minimize Σ f subject to (G Gᵀ) f >= d, f >= 0. Residuals belong to the data as given, nothing scaled.
struct LpResult {
  LpStatus status = LpStatus::stalled;
  double objective = 0;        ///< Σ f
  double dual_objective = 0;   ///< dᵀ y; the duality gap is objective - dual_objective
  double primal_residual = 0;  ///< largest d_i - g_i·w above zero, in the unit of d
  double dual_residual = 0;    ///< largest g_i·Gᵀy - 1 above zero (the costs are 1)
  int iterations = 0;          ///< pivots
  SparseRows force;            ///< the nonzero f (at most 6), all >= 0; empty unless optimal
  SparseRows dual;        ///< optimal: y (at most 6). infeasible: Farkas y >= 0, Gᵀy ≈ 0, dᵀy > 0. Else empty
  Vec6 w = Vec6::Zero();  ///< the motion Gᵀ f; zero unless optimal
  /// Infeasible only: every x with G x >= d is longer than this (dᵀy / |Gᵀy|).
  double reach = std::numeric_limits<double>::infinity();
};

/// The linear program of the paper (equations 5 to 7 in the form of docs: A = J M⁻¹ Jᵀ = G Gᵀ) by the dual simplex
/// method. The basis is at most six forces and as many tight rows because A has rank six; a pivot costs two passes over
/// the rows, and A is never formed.
/// Starts from f = 0, which is dual feasible. Deterministic: the same input gives the
/// same bits on every CPU. `solve` allocates nothing.
class LpSolver {
 public:
  /// For programs of at most `capacity` rows.
  explicit LpSolver(int capacity) : rows_(capacity) {}

  /// `d` has g.rows() entries. Non-finite input and too many rows give `stalled`. The result lives until the next call.
  const LpResult& solve(const LowRankMatrix& g, const double* d) noexcept;

 private:
  /// A basic variable that must leave, as a row of the tableau: `slack[q]` multiplies the tight row q, `v·g_j` force j.
  struct Leaving {
    int row = -1;    ///< the violated row, or -1
    int force = -1;  ///< the position in the basis of a negative force, or -1
    double violation = 0;
    double slack[6] = {};
    Vec6 v = Vec6::Zero();
    double weight = 0;  ///< 1-norm of the dual direction
  };
  /// The nonbasic variable that enters.
  struct Entering {
    int force = -1;  ///< a column, or -1
    int slack = -1;  ///< a position among the tight rows, or -1
    double step = 0;
  };

  bool solve_basis() noexcept;
  bool choose_leaving(bool first_index, Leaving& out) noexcept;
  void tableau_row(Leaving& leaving) const noexcept;
  bool choose_entering(const Leaving& leaving, bool first_index, Entering& out) noexcept;
  bool pivot(const Leaving& leaving, const Entering& entering) noexcept;
  bool certify_infeasible(const Leaving& leaving) noexcept;
  void finish() noexcept;

  RowWorkspace rows_;
  const LowRankMatrix* g_ = nullptr;
  int size_ = 0;           ///< basic forces = tight rows
  int force_[6] = {};      ///< the basic forces (columns)
  int tight_[6] = {};      ///< the tight rows
  SpanBasis force_span_;   ///< of the unit rows of the basic forces: the motions they can make
  SpanBasis tight_span_;   ///< of the unit tight rows
  SmallLu cross_;          ///< products of the two bases, forces by tight rows
  double f_[6] = {};       ///< basic forces times the row length
  double y_[6] = {};       ///< duals times the row length
  Vec6 w_ = Vec6::Zero();  ///< Gᵀ f
  Vec6 u_ = Vec6::Zero();  ///< Gᵀ y
  LpResult result_;
};

}  // namespace tegotae
