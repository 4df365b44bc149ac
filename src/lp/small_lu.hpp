#pragma once

#include <cmath>
#include <utility>

namespace tegotae {

/// LU factors with row exchanges of a square matrix of order at most six.
class SmallLu {
 public:
  /// Factors the leading n×n part of `a`; false when it is singular.
  bool factor(const double (&a)[6][6], int n) noexcept {
    n_ = n;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        a_[i][j] = a[i][j];
      }
    }
    for (int k = 0; k < n; ++k) {
      int p = k;
      for (int i = k + 1; i < n; ++i) {
        p = std::abs(a_[i][k]) > std::abs(a_[p][k]) ? i : p;
      }
      exchange_[k] = p;
      if (!(std::abs(a_[p][k]) > 0)) {
        return false;
      }
      if (p != k) {
        std::swap(a_[p], a_[k]);
      }
      inverse_[k] = 1 / a_[k][k];
      for (int i = k + 1; i < n; ++i) {
        a_[i][k] *= inverse_[k];
        for (int j = k + 1; j < n; ++j) {
          a_[i][j] -= a_[i][k] * a_[k][j];
        }
      }
    }
    return true;
  }

  /// b becomes A⁻¹ b.
  void solve(double* b) const noexcept {
    for (int k = 0; k < n_; ++k) {
      std::swap(b[k], b[exchange_[k]]);
    }
    for (int k = 1; k < n_; ++k) {
      for (int j = 0; j < k; ++j) {
        b[k] -= a_[k][j] * b[j];
      }
    }
    for (int k = n_ - 1; k >= 0; --k) {
      for (int j = k + 1; j < n_; ++j) {
        b[k] -= a_[k][j] * b[j];
      }
      b[k] *= inverse_[k];
    }
  }

  /// b becomes A⁻ᵀ b.
  void solve_transposed(double* b) const noexcept {
    for (int k = 0; k < n_; ++k) {
      for (int j = 0; j < k; ++j) {
        b[k] -= a_[j][k] * b[j];
      }
      b[k] *= inverse_[k];
    }
    for (int k = n_ - 2; k >= 0; --k) {
      for (int j = k + 1; j < n_; ++j) {
        b[k] -= a_[j][k] * b[j];
      }
    }
    for (int k = n_ - 1; k >= 0; --k) {
      std::swap(b[k], b[exchange_[k]]);
    }
  }

 private:
  int n_ = 0;
  double a_[6][6] = {};
  double inverse_[6] = {};
  int exchange_[6] = {};
};

}  // namespace tegotae
