#include "lp/least_distance.hpp"

#include <algorithm>
#include <cmath>

namespace tegotae {
namespace {

/// A row counts as satisfied when it is short by less than this part of the largest violation at z0.
constexpr double kFeasibility = 1e-10;
/// The same relative to the lengths of the motion and of z0: rounding of g·x and of b - g·z0.
constexpr double kRounding = 1e-14;
/// A unit row whose part outside the span of the active rows is shorter than this depends on them.
constexpr double kDependent = 1e-10;
/// Far above the 2 to 30 changes that solves take.
constexpr int kMaxChanges = 400;
/// Changes after which rounding must be what keeps the solve going, and kAccepted will do.
constexpr int kPatience = 100;
/// "Infeasible" is only said when a solution would have to move this many times the largest violation.
constexpr double kHopeless = 1e8;
/// Residuals above this part of the data's size are not called optimal.
constexpr double kAccepted = 1e-6;

}  // namespace

const QpResult& LeastDistanceSolver::solve(const LowRankMatrix& g, const double* b, const Vec6& z0, const int* warm,
                                           int warm_count) noexcept {
  result_ = QpResult{};
  result_.z = z0;
  g_ = &g;
  size_ = 0;
  span_.clear();
  x_.setZero();
  const RowWorkspace::Input input = rows_.load(g, b, z0);
  if (input == RowWorkspace::Input::bad) {
    return result_;
  }
  if (input == RowWorkspace::Input::infeasible) {
    result_.status = LpStatus::infeasible;
    result_.multipliers.add(rows_.zero_row(), 1);
    return result_;
  }
  start_from(warm, warm_count);
  for (;;) {
    const RowChoice violated = rows_.most_violated(x_);
    const double tolerance = result_.iterations < kPatience
                                 ? kFeasibility * rows_.largest_violation() + kRounding * (x_.norm() + z0.norm())
                                 : kAccepted * (rows_.largest_violation() + x_.norm()) + kRounding * z0.norm();
    if (!(violated.value > tolerance)) {
      finish(b, z0);
      return result_;
    }
    if (!raise(violated)) {
      return result_;
    }
  }
}

bool LeastDistanceSolver::raise(const RowChoice& violated) noexcept {
  const Vec6 row = rows_.unit_row(violated.row);
  const double target = rows_.d(violated.row) * rows_.inverse_norm(violated.row);
  for (;;) {
    if (++result_.iterations > kMaxChanges) {
      return false;
    }
    Vec6 outside;
    double along[6];
    span_.split(row, outside, along);
    span_.solve_upper(along);
    const double square = outside.squaredNorm();
    const bool independent = size_ < 6 && square > kDependent * kDependent;
    double step = std::numeric_limits<double>::infinity();
    int blocking = -1;
    for (int i = 0; i < size_; ++i) {
      if (along[i] > 0 && lambda_[i] < step * along[i]) {
        step = lambda_[i] / along[i];
        blocking = i;
      }
    }
    const double full = independent ? std::max(target - row.dot(x_), 0.0) / square : step;
    if (!independent && blocking < 0) {
      return leave_dependent(violated, along);
    }
    if (independent && full <= step) {
      append(violated.row);
      solve_active();
      return true;
    }
    if (independent) {
      x_ += step * outside;
    }
    for (int i = 0; i < size_; ++i) {
      lambda_[i] = std::max(lambda_[i] - step * along[i], 0.0);
    }
    drop(blocking);
  }
}

bool LeastDistanceSolver::leave_dependent(const RowChoice& violated, const double* along) noexcept {
  if (certify_infeasible(violated.row, along)) {
    result_.status = LpStatus::infeasible;
    return false;
  }
  if (violated.value > kAccepted * (rows_.largest_violation() + x_.norm())) {
    return false;
  }
  // The row depends on the active ones but for rounding, and so does what it is short by: leave it at that.
  rows_.set_row_priced(violated.row, false);
  return true;
}

bool LeastDistanceSolver::append(int row) noexcept {
  if (!span_.append(rows_.unit_row(row), kDependent)) {
    return false;
  }
  active_[size_++] = row;
  rows_.set_row_priced(row, false);
  return true;
}

void LeastDistanceSolver::drop(int position) noexcept {
  rows_.set_row_priced(active_[position], true);
  span_.remove(position);
  std::copy(active_ + position + 1, active_ + size_, active_ + position);
  std::copy(lambda_ + position + 1, lambda_ + size_, lambda_ + position);
  --size_;
}

void LeastDistanceSolver::solve_active() noexcept {
  for (int i = 0; i < size_; ++i) {
    lambda_[i] = rows_.d(active_[i]) * rows_.inverse_norm(active_[i]);
  }
  span_.solve_lower(lambda_);
  x_.setZero();
  for (int i = 0; i < size_; ++i) {
    x_ += lambda_[i] * span_.basis(i);
  }
  span_.solve_upper(lambda_);
}

void LeastDistanceSolver::start_from(const int* warm, int warm_count) noexcept {
  for (int i = 0; i < warm_count && size_ < 6; ++i) {
    if (warm[i] >= 0 && warm[i] < rows_.count() && rows_.inverse_norm(warm[i]) > 0) {
      append(warm[i]);
    }
  }
  // The method may start from any set of rows whose own problem has them all pulling.
  for (;;) {
    solve_active();
    const double* least = std::min_element(lambda_, lambda_ + size_);
    if (size_ == 0 || *least >= 0) {
      return;
    }
    drop(static_cast<int>(least - lambda_));
  }
}

bool LeastDistanceSolver::certify_infeasible(int row, const double* along) noexcept {
  Vec6 z = rows_.unit_row(row);
  double gain = rows_.d(row) * rows_.inverse_norm(row);
  result_.multipliers.add(row, rows_.inverse_norm(row));
  for (int i = 0; i < size_; ++i) {
    const double y = std::max(-along[i], 0.0);
    if (y > 0) {
      z += y * rows_.unit_row(active_[i]);
      gain += y * rows_.d(active_[i]) * rows_.inverse_norm(active_[i]);
      result_.multipliers.add(active_[i], y * rows_.inverse_norm(active_[i]));
    }
  }
  result_.reach = gain / z.norm();
  if (gain > 0 && result_.reach > kHopeless * rows_.largest_violation()) {
    return true;
  }
  result_.multipliers = {};
  return false;
}

void LeastDistanceSolver::finish(const double* b, const Vec6& z0) noexcept {
  result_.z = z0 + x_;
  const Vec6 x = result_.z - z0;
  result_.objective = 0.5 * x.squaredNorm();
  double worst = 0;
  for (int i = 0; i < g_->rows(); ++i) {
    const double short_by = b[i] - g_->row(i).dot(result_.z);
    result_.primal_residual = std::max(result_.primal_residual, short_by);
    worst = std::max(worst, (rows_.d(i) - g_->row(i).dot(x_)) * rows_.inverse_norm(i));
  }
  Vec6 rest = x;
  double terms = 0;  // of Gᵀ λ, which cancel
  for (int i = 0; i < size_; ++i) {
    const double lambda = std::max(lambda_[i], 0.0) * rows_.inverse_norm(active_[i]);
    if (lambda > 0) {
      const Vec6 row = g_->row(active_[i]);
      result_.multipliers.add(active_[i], lambda);
      rest -= lambda * row;
      result_.complementarity =
          std::max(result_.complementarity, lambda * std::abs(row.dot(result_.z) - b[active_[i]]));
      terms += lambda * row.norm();
    }
  }
  result_.dual_residual = rest.norm();
  if (worst <= kAccepted * (rows_.largest_violation() + x_.norm()) + kRounding * z0.norm() &&
      result_.dual_residual <= kAccepted * x_.norm() + kRounding * (terms + z0.norm())) {
    result_.status = LpStatus::optimal;
    return;
  }
  result_.z = z0;
  result_.multipliers = {};
}

}  // namespace tegotae
