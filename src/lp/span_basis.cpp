#include "lp/span_basis.hpp"

#include <algorithm>

namespace tegotae {

void SpanBasis::split(const Vec6& row, Vec6& outside, double* inside) const noexcept {
  outside = row;
  std::fill_n(inside, 6, 0.0);
  // Once will do while most of the row remains; else a second pass removes what rounding left of the span.
  constexpr double kMax = 0.25;
  const double enough = kMax * row.squaredNorm();
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < size_; ++i) {
      const double h = basis_[i].dot(outside);
      inside[i] += h;
      outside -= h * basis_[i];
    }
    if (outside.squaredNorm() > enough) {
      return;
    }
  }
}

bool SpanBasis::append(const Vec6& row, double dependent) noexcept {
  Vec6 outside;
  double inside[6];
  split(row, outside, inside);
  const double length = outside.norm();
  if (size_ == 6 || !(length > dependent)) {
    return false;
  }
  for (int i = 0; i < size_; ++i) {
    r_[i][size_] = inside[i];
  }
  inverse_[size_] = 1 / length;
  basis_[size_] = outside * inverse_[size_];
  row_[size_] = row;
  ++size_;
  return true;
}

void SpanBasis::remove(int position) noexcept {
  const int count = size_;
  size_ = position;
  for (int i = position + 1; i < count; ++i) {
    const Vec6 row = row_[i];
    append(row, 0);
  }
}

void SpanBasis::solve_upper(double* h) const noexcept {
  for (int i = size_ - 1; i >= 0; --i) {
    for (int j = i + 1; j < size_; ++j) {
      h[i] -= r_[i][j] * h[j];
    }
    h[i] *= inverse_[i];
  }
}

void SpanBasis::solve_lower(double* h) const noexcept {
  for (int i = 0; i < size_; ++i) {
    for (int j = 0; j < i; ++j) {
      h[i] -= r_[j][i] * h[j];
    }
    h[i] *= inverse_[i];
  }
}

}  // namespace tegotae
