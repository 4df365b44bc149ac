#pragma once

#include "tegotae/core/pose.hpp"

namespace tegotae {

/// At most six independent rows as row_j = Σ_i R_ij basis_i, with an orthonormal basis and R upper triangular. Systems
/// are solved through it, so that nearly parallel rows cost their angle in accuracy, not its square.
class SpanBasis {
 public:
  int size() const noexcept { return size_; }
  void clear() noexcept { size_ = 0; }
  const Vec6& basis(int i) const noexcept { return basis_[i]; }

  /// row = outside + Σ inside_i basis_i, with `outside` orthogonal to the span. `inside` holds six numbers.
  void split(const Vec6& row, Vec6& outside, double* inside) const noexcept;
  /// Appends `row` unless there are six or its part outside the span is at most `dependent` long.
  bool append(const Vec6& row, double dependent) noexcept;
  /// Removes the row at `position`; those behind it move up.
  void remove(int position) noexcept;

  /// h becomes R⁻¹ h: coefficients over the basis to coefficients over the rows.
  void solve_upper(double* h) const noexcept;
  /// h becomes R⁻ᵀ h: products with the rows to products with the basis.
  void solve_lower(double* h) const noexcept;

 private:
  int size_ = 0;
  Vec6 row_[6];
  Vec6 basis_[6];
  double r_[6][6] = {};     ///< above the diagonal
  double inverse_[6] = {};  ///< of the diagonal of R
};

}  // namespace tegotae
