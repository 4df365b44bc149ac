#pragma once

#include <cstddef>
#include <vector>

#include "lp/pricing.hpp"
#include "tegotae/lp/low_rank_matrix.hpp"

namespace tegotae {

/// What both solvers keep for each row, and the passes over it. Rows are scaled to unit length, so that rows in m and
/// rows in m/rad compare.
class RowWorkspace {
 public:
  explicit RowWorkspace(int capacity);

  enum class Input { good, bad, infeasible };
  /// Takes G and d (g.rows() entries, minus g_i·shift). `bad`: not finite, or more rows than the capacity.
  /// `infeasible`: the zero row `zero_row()` has d > 0.
  Input load(const LowRankMatrix& g, const double* d, const Vec6& shift) noexcept;

  int count() const noexcept { return count_; }
  int zero_row() const noexcept { return zero_row_; }
  /// Largest d_i / |g_i|, at least 0: how far from a solution x = 0 is.
  double largest_violation() const noexcept { return largest_; }
  double inverse_norm(int i) const noexcept { return at(inverse_norm_, i); }
  double d(int i) const noexcept { return at(d_, i); }
  Vec6 unit_row(int i) const noexcept { return g_->row(i) * inverse_norm(i); }

  /// Whether row i takes part in `most_violated`, and as a column in `bound_steps`.
  void set_row_priced(int i, bool on) noexcept { at(row_scale_, i) = on ? inverse_norm(i) : 0; }
  void set_column_priced(int i, bool on) noexcept { at(column_scale_, i) = on ? inverse_norm(i) : 0; }

  /// The row farthest from being satisfied by x: (d_i - g_i·x) / |g_i|.
  RowChoice most_violated(const Vec6& x) const noexcept;
  /// The first row violated by more than `tolerance`.
  RowChoice first_violated(const Vec6& x, double tolerance) const noexcept;
  /// See Pricing::steps.
  double bound_steps(const Vec6& u, const Vec6& v, double min_pivot, double slack) noexcept;
  /// See Pricing::largest_pivot; of the steps last bounded.
  RowChoice largest_pivot(double bound) const noexcept;
  /// The first column whose step is within `bound`, of the steps last bounded.
  RowChoice first_step(double bound) const noexcept;
  double step(int j) const noexcept { return at(step_, j); }

 private:
  static double at(const std::vector<LaneBlock>& a, int i) noexcept {
    return a[static_cast<std::size_t>(i / kRowLanes)].v[i % kRowLanes];
  }
  static double& at(std::vector<LaneBlock>& a, int i) noexcept {
    return a[static_cast<std::size_t>(i / kRowLanes)].v[i % kRowLanes];
  }

  const Pricing& pricing_;
  const LowRankMatrix* g_ = nullptr;
  int capacity_;
  int count_ = 0;
  int blocks_ = 0;
  int zero_row_ = -1;
  double largest_ = 0;
  std::vector<LaneBlock> d_, inverse_norm_, row_scale_, column_scale_, step_, pivot_;
};

}  // namespace tegotae
