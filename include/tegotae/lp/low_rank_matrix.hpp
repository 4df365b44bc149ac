#pragma once

#include <cstddef>
#include <vector>

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Rows that one pricing step takes together; also the padding of every per-row array.
inline constexpr int kRowLanes = 8;

/// Eight rows of six, coefficient by coefficient, so that wide instructions work across rows.
struct alignas(64) RowBlock {
  double g[6][kRowLanes];  ///< coefficient, then row
};

/// Eight numbers, one a row.
struct alignas(64) LaneBlock {
  double v[kRowLanes];  ///< by row
};

/// N×6 matrix G with a fixed capacity: the rows of G x >= d, in the metric in which the length of x counts. For a rigid
/// body with contact Jacobian J and mass matrix M, G = J M^(-1/2) and x = M^(1/2) δ. Filling never allocates.
class LowRankMatrix {
 public:
  /// Empty, with room for `capacity` rows; the only call that allocates.
  explicit LowRankMatrix(int capacity)
      : capacity_(capacity), blocks_(static_cast<std::size_t>((capacity + kRowLanes - 1) / kRowLanes)) {}

  /// Takes all rows out; the capacity stays.
  void clear() noexcept { rows_ = 0; }

  /// Appends the row `g`; false, and nothing happens, when the matrix is full.
  bool push_row(const Vec6& g) noexcept {
    if (rows_ == capacity_) {
      return false;
    }
    RowBlock& block = blocks_[static_cast<std::size_t>(rows_ / kRowLanes)];
    for (int k = 0; k < 6; ++k) {
      block.g[k][rows_ % kRowLanes] = g[k];
    }
    ++rows_;
    return true;
  }

  int rows() const noexcept { return rows_; }          ///< N
  int capacity() const noexcept { return capacity_; }  ///< the most that rows() can be
  /// Rows by eights; what is beyond rows() in the last block is of no meaning.
  const RowBlock* blocks() const noexcept { return blocks_.data(); }

  /// Row `i` of rows().
  Vec6 row(int i) const noexcept {
    const RowBlock& block = blocks_[static_cast<std::size_t>(i / kRowLanes)];
    Vec6 g;
    for (int k = 0; k < 6; ++k) {
      g[k] = block.g[k][i % kRowLanes];
    }
    return g;
  }

 private:
  int capacity_;
  int rows_ = 0;
  std::vector<RowBlock> blocks_;
};

}  // namespace tegotae
