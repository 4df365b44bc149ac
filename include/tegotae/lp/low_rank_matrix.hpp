#pragma once

#include <cstddef>
#include <vector>

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Number of rows that one pricing step processes together. Every per-row array is padded to a multiple of it.
inline constexpr int kRowLanes = 8;

/// Eight rows of six numbers, stored coefficient by coefficient, so that wide instructions work across rows.
struct alignas(64) RowBlock {
  double g[6][kRowLanes];  ///< coefficient, then row
};

/// Eight numbers, one for each row.
struct alignas(64) LaneBlock {
  double v[kRowLanes];  ///< by row
};

/// N×6 matrix G of fixed capacity: the rows of G x >= d. Lengths of x are in the metric of x: for a rigid body with
/// contact Jacobian J and mass matrix M, G = J M^(-1/2) and x = M^(1/2) δ. Filling the matrix never allocates.
class LowRankMatrix {
 public:
  /// Makes an empty matrix for up to `capacity` rows. No other call allocates.
  explicit LowRankMatrix(int capacity)
      : capacity_(capacity), blocks_(static_cast<std::size_t>((capacity + kRowLanes - 1) / kRowLanes)) {}

  /// Removes all rows; the capacity stays.
  void clear() noexcept { rows_ = 0; }

  /// Appends the row `g`. Returns false, and changes nothing, when the matrix is full.
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
  int capacity() const noexcept { return capacity_; }  ///< largest possible rows()
  /// Returns the rows in blocks of eight. Entries beyond rows() in the last block have no meaning.
  const RowBlock* blocks() const noexcept { return blocks_.data(); }

  /// Returns row `i`, from 0 to rows() - 1.
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
