#pragma once

#include "tegotae/lp/low_rank_matrix.hpp"

namespace tegotae {

/// A row and what it was chosen for; row -1 when there is none.
struct RowChoice {
  int row = -1;
  double value = 0;
};

/// Six numbers, and two zeros.
struct alignas(64) PaddedVec6 {
  double v[kRowLanes];
};

/// Passes over all rows, in wide instructions chosen at run time. No sum crosses rows and ties go to the lowest row, so
/// every CPU gives the same bits. `blocks` counts blocks of kRowLanes rows; rows of scale 0 are never chosen.
struct Pricing {
  /// inverse_norm = 1 / |g_i| for each row, not finite where the row is zero.
  void (*inverse_norms)(const RowBlock* g, int blocks, LaneBlock* inverse_norm);
  /// The row with the largest scale_i (d_i - g_i·w) above zero.
  RowChoice (*most_violated)(const RowBlock* g, const LaneBlock* d, const LaneBlock* scale, int blocks,
                             const double* w);
  /// For each row j with pivot_j = scale_j v·g_j > min_pivot: step_j = max(1 - u·g_j, 0) / v·g_j; for others pivot 0
  /// and step infinite. Returns the least (max(1 - u·g_j, 0) + slack) / v·g_j.
  double (*steps)(const RowBlock* g, const LaneBlock* scale, int blocks, const double* u, const double* v,
                  double min_pivot, double slack, LaneBlock* step, LaneBlock* pivot);
  /// The row with the largest pivot among those with step <= bound.
  RowChoice (*largest_pivot)(const LaneBlock* step, const LaneBlock* pivot, int blocks, double bound);
  /// The row with the largest d_i - g_i·w + |(t0_i·w, t1_i·w)| above `least`. Rows with d = -inf are never chosen.
  RowChoice (*most_violated_cone)(const RowBlock* g, const RowBlock* t0, const RowBlock* t1, const LaneBlock* d,
                                  int blocks, const double* w, double least);
  /// h = Σ_k a_k b_kᵀ, six rows; added in the order of k.
  void (*sum_products)(const PaddedVec6* a, const PaddedVec6* b, int n, PaddedVec6* h);
};

enum class InstructionSet { baseline, avx2, avx512 };
/// The passes compiled for `set`; null when this CPU does not run it.
const Pricing* pricing(InstructionSet set) noexcept;
/// The widest that this CPU runs.
const Pricing& pricing() noexcept;

}  // namespace tegotae
