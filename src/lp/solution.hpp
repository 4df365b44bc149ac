#pragma once

#include <array>

#include "tegotae/core/pose.hpp"

namespace tegotae {

/// How a solve ended.
enum class LpStatus {
  optimal,     ///< solved, and checked against the original data
  infeasible,  ///< no solution, and the dual vector returned proves it
  stalled      ///< neither: bad input (not finite, more rows than the capacity), iteration limit, or lost precision
};

/// Multipliers of a few rows; all others are zero. Six suffice at an optimum, seven for a proof of infeasibility.
struct SparseRows {
  static constexpr int kMax = 7;
  int count = 0;
  std::array<int, kMax> index{};
  std::array<double, kMax> value{};

  void add(int row, double v) noexcept {
    index[count] = row;
    value[count] = v;
    ++count;
  }
};

}  // namespace tegotae
