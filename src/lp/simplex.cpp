#include "lp/simplex.hpp"

#include <algorithm>
#include <cmath>

#include "core/numbers.hpp"

namespace tegotae {
namespace {

/// A row counts as satisfied when it is short by less than this part of the largest violation at f = 0.
constexpr double kFeasibility = 1e-10;
/// The same relative to the length of the motion: rounding of g·w, with room for the cancellation in w = Gᵀ f.
constexpr double kRounding = 1e-13;
/// Reduced costs (costs are 1) may be negative by this; what Harris's ratio test trades for larger pivots.
constexpr double kDualSlack = 1e-9;
/// v is a sum of unit rows times the dual direction; below this part of the direction's size it is rounding, and zero.
constexpr double kDependent = 1e-9;
/// A column whose pivot is below this part of the smallest that must exist (see choose_entering) is left out of the
/// ratio test: its reduced cost may turn negative by as much.
constexpr double kPivot = 1e-9;
/// Degenerate pivots in a row before Bland's rule takes over: a few bases' worth.
constexpr int kDegenerateRun = 12;
/// Dual steps below this part of the duals' own size are degenerate.
constexpr double kDegenerateStep = 1e-12;
/// Pivots before a solve is given up: at least so many, and so many for each row. Most solves take 10 to 40; a round
/// peg that leans in its hole takes up to 1.3 for each row of its rims.
constexpr int kMinPivots = 400, kPivotsPerRow = 4;
/// "Infeasible" is only said when a solution would have to move this many times the largest violation.
constexpr double kHopeless = 1e8;
/// Residuals above this part of the data's size are not called optimal.
constexpr double kAccepted = 1e-6;

}  // namespace

const LpResult& LpSolver::solve(const LowRankMatrix& g, const double* d) noexcept {
  result_ = LpResult{};
  g_ = &g;
  size_ = 0;
  force_span_.clear();
  tight_span_.clear();
  const RowWorkspace::Input input = rows_.load(g, d, Vec6::Zero());
  if (input == RowWorkspace::Input::bad) {
    return result_;
  }
  if (input == RowWorkspace::Input::infeasible) {
    result_.status = LpStatus::infeasible;
    result_.dual.add(rows_.zero_row(), 1);
    return result_;
  }
  const int most = std::max(kMinPivots, kPivotsPerRow * g.rows());
  int degenerate = 0;
  for (;; ++result_.iterations) {
    if (!solve_basis()) {
      return result_;
    }
    const bool bland = degenerate > kDegenerateRun;
    Leaving leaving;
    if (!choose_leaving(bland, leaving)) {
      finish();
      return result_;
    }
    if (result_.iterations == most) {
      return result_;
    }
    tableau_row(leaving);
    Entering entering;
    if (!choose_entering(leaving, bland, entering)) {
      if (leaving.row >= 0 && certify_infeasible(leaving)) {
        result_.status = LpStatus::infeasible;
        return result_;
      }
      if (leaving.row < 0 || leaving.violation > kAccepted * (rows_.largest_violation() + w_.norm())) {
        return result_;
      }
      // The row depends on the tight ones but for rounding, and so does what it is short by: leave it at that.
      rows_.set_row_priced(leaving.row, false);
      continue;
    }
    // Bland's rule forbids cycles among degenerate pivots; every other pivot raises the dual objective.
    degenerate = entering.step * leaving.weight > kDegenerateStep * (1 + u_.norm()) ? 0 : degenerate + 1;
    if (!pivot(leaving, entering)) {
      return result_;
    }
  }
}

bool LpSolver::solve_basis() noexcept {
  // The tight rows of A over the basic forces are R_Qᵀ U_Qᵀ U_P R_P, with U and R of the two spans.
  double cross[6][6];
  for (int p = 0; p < size_; ++p) {
    for (int q = 0; q < size_; ++q) {
      cross[p][q] = force_span_.basis(p).dot(tight_span_.basis(q));
    }
  }
  if (!cross_.factor(cross, size_)) {
    return false;
  }
  for (int k = 0; k < size_; ++k) {
    f_[k] = rows_.d(tight_[k]) * rows_.inverse_norm(tight_[k]);
    y_[k] = rows_.inverse_norm(force_[k]);
  }
  tight_span_.solve_lower(f_);
  cross_.solve_transposed(f_);
  force_span_.solve_lower(y_);
  cross_.solve(y_);
  w_.setZero();
  u_.setZero();
  for (int k = 0; k < size_; ++k) {
    w_ += f_[k] * force_span_.basis(k);
    u_ += y_[k] * tight_span_.basis(k);
  }
  force_span_.solve_upper(f_);
  tight_span_.solve_upper(y_);
  return true;
}

bool LpSolver::choose_leaving(bool first_index, Leaving& out) noexcept {
  const double size = *std::max_element(f_, f_ + std::max(size_, 1));
  const double row_tolerance = kFeasibility * rows_.largest_violation() + kRounding * (w_.norm() + (size_ ? size : 0));
  const RowChoice row = first_index ? rows_.first_violated(w_, row_tolerance) : rows_.most_violated(w_);
  if (row.row >= 0 && row.value > row_tolerance) {
    out.row = row.row;
    out.violation = row.value;
    if (first_index) {
      return true;
    }
  }
  for (int p = 0; p < size_; ++p) {
    // Bland's order: rows before forces, each by number.
    const bool before = first_index ? out.force < 0 || force_[p] < force_[out.force] : -f_[p] > out.violation;
    if (-f_[p] > row_tolerance && before) {
      out.row = -1;
      out.force = p;
      out.violation = -f_[p];
    }
  }
  return out.row >= 0 || out.force >= 0;
}

void LpSolver::tableau_row(Leaving& leaving) const noexcept {
  // v moves no basic force but the leaving one: the part of the row that the tight rows cannot undo.
  if (leaving.row >= 0) {
    leaving.v = rows_.unit_row(leaving.row);
    leaving.weight = 1;
    // Where the row nearly depends on the tight ones, a second pass removes the rounding of the first.
    constexpr double kMax = 0.01;
    for (int pass = 0; pass < 2 && (pass == 0 || leaving.v.squaredNorm() < kMax); ++pass) {
      double part[6] = {};
      for (int p = 0; p < size_; ++p) {
        part[p] = force_span_.basis(p).dot(leaving.v);
      }
      cross_.solve(part);
      for (int q = 0; q < size_; ++q) {
        leaving.slack[q] += part[q];
        leaving.v -= part[q] * tight_span_.basis(q);
      }
    }
  } else {
    leaving.slack[leaving.force] = 1;
    force_span_.solve_lower(leaving.slack);
    cross_.solve(leaving.slack);
    for (int q = 0; q < size_; ++q) {
      leaving.v -= leaving.slack[q] * tight_span_.basis(q);
    }
  }
  tight_span_.solve_upper(leaving.slack);
  for (int q = 0; q < size_; ++q) {
    leaving.weight += std::abs(leaving.slack[q]);
  }
}

bool LpSolver::choose_entering(const Leaving& leaving, bool first_index, Entering& out) noexcept {
  // When no slack can enter, v = Gᵀ y with y >= 0 of 1-norm `weight`, so some row of y has v·g >= |v|²/weight: a
  // smaller pivot than about that need never be taken. With six tight rows v is zero.
  const double length = leaving.v.norm();
  const bool columns = size_ < 6 || leaving.row < 0;
  const double min_pivot =
      columns && length > kDependent * leaving.weight ? kPivot * length * length / leaving.weight : kInfinity;
  const double slack = first_index ? 0 : kDualSlack;
  double bound = min_pivot < kInfinity ? rows_.bound_steps(u_, leaving.v, min_pivot, slack) : kInfinity;
  double y_size = 0;
  double slack_size = 0;
  for (int q = 0; q < size_; ++q) {
    y_size = std::max(y_size, std::abs(y_[q]));
    slack_size = std::max(slack_size, std::abs(leaving.slack[q]));
  }
  const double min_slack = kDependent * slack_size;
  for (int q = 0; q < size_; ++q) {
    if (leaving.slack[q] > min_slack) {
      bound = std::min(bound, (std::max(y_[q], 0.0) + slack * y_size) / leaving.slack[q]);
    }
  }
  if (!(bound < kInfinity)) {
    return false;
  }
  double best = 0;
  for (int q = 0; q < size_; ++q) {
    const double step = std::max(y_[q], 0.0) / leaving.slack[q];
    if (leaving.slack[q] > min_slack && step <= bound) {
      // Bland's order: rows before forces, each by number.
      if (first_index ? out.slack < 0 || tight_[q] < tight_[out.slack] : leaving.slack[q] > best) {
        best = leaving.slack[q];
        out.slack = q;
        out.step = step;
      }
    }
  }
  if (min_pivot < kInfinity && !(first_index && out.slack >= 0)) {
    const RowChoice column = first_index ? rows_.first_step(bound) : rows_.largest_pivot(bound);
    if (column.row >= 0 && column.value > best) {
      out.slack = -1;
      out.force = column.row;
      out.step = rows_.step(column.row);
    }
  }
  return out.slack >= 0 || out.force >= 0;
}

bool LpSolver::pivot(const Leaving& leaving, const Entering& entering) noexcept {
  int tight_count = size_;
  int force_count = size_;
  if (entering.slack >= 0) {
    rows_.set_row_priced(tight_[entering.slack], true);
    tight_span_.remove(entering.slack);
    std::copy(tight_ + entering.slack + 1, tight_ + size_, tight_ + entering.slack);
    --tight_count;
  }
  if (leaving.force >= 0) {
    rows_.set_column_priced(force_[leaving.force], true);
    force_span_.remove(leaving.force);
    std::copy(force_ + leaving.force + 1, force_ + size_, force_ + leaving.force);
    --force_count;
  }
  if (leaving.row >= 0) {
    if (!tight_span_.append(rows_.unit_row(leaving.row), 0)) {
      return false;
    }
    rows_.set_row_priced(leaving.row, false);
    tight_[tight_count++] = leaving.row;
  }
  if (entering.force >= 0) {
    if (!force_span_.append(rows_.unit_row(entering.force), 0)) {
      return false;
    }
    rows_.set_column_priced(entering.force, false);
    force_[force_count] = entering.force;
  }
  size_ = tight_count;
  return true;
}

bool LpSolver::certify_infeasible(const Leaving& leaving) noexcept {
  Vec6 z = rows_.unit_row(leaving.row);
  double gain = rows_.d(leaving.row) * rows_.inverse_norm(leaving.row);
  result_.dual.add(leaving.row, rows_.inverse_norm(leaving.row));
  for (int q = 0; q < size_; ++q) {
    const double y = std::max(-leaving.slack[q], 0.0);
    if (y > 0) {
      z += y * rows_.unit_row(tight_[q]);
      gain += y * rows_.d(tight_[q]) * rows_.inverse_norm(tight_[q]);
      result_.dual.add(tight_[q], y * rows_.inverse_norm(tight_[q]));
    }
  }
  result_.reach = gain / z.norm();
  if (gain > 0 && result_.reach > kHopeless * rows_.largest_violation()) {
    return true;
  }
  result_.dual = {};
  return false;
}

void LpSolver::finish() noexcept {
  result_.w = w_;
  double terms = 0;  // of the dual objective, which cancel
  for (int k = 0; k < size_; ++k) {
    const double f = std::max(f_[k], 0.0) * rows_.inverse_norm(force_[k]);
    const double y = std::max(y_[k], 0.0) * rows_.inverse_norm(tight_[k]);
    if (f > 0) {
      result_.force.add(force_[k], f);
      result_.objective += f;
    }
    if (y > 0) {
      result_.dual.add(tight_[k], y);
      terms += y * std::abs(rows_.d(tight_[k]));
      result_.dual_objective += y * rows_.d(tight_[k]);
    }
  }
  double worst = 0;
  for (int i = 0; i < g_->rows(); ++i) {
    const Vec6 row = g_->row(i);
    const double short_by = rows_.d(i) - row.dot(result_.w);
    result_.primal_residual = std::max(result_.primal_residual, short_by);
    worst = std::max(worst, short_by * rows_.inverse_norm(i));
    result_.dual_residual = std::max(result_.dual_residual, row.dot(u_) - 1);
  }
  const double gap = std::abs(result_.objective - result_.dual_objective);
  if (worst <= kAccepted * (rows_.largest_violation() + result_.w.norm()) && result_.dual_residual <= kAccepted &&
      gap <= kAccepted * result_.objective + kRounding * terms) {
    result_.status = LpStatus::optimal;
    return;
  }
  result_.force = {};
  result_.dual = {};
  result_.w.setZero();
}

}  // namespace tegotae
