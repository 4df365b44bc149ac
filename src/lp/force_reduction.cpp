#include "lp/force_reduction.hpp"

#include <algorithm>
#include <cmath>

namespace tegotae {
namespace {

constexpr std::size_t kMax = 6;

Vec6 action(const FrictionProblem& p, const FrictionForce& f) noexcept {
  Vec6 w = f.normal * p.normals.row(f.row);
  if (p.mu[f.row] > 0) w += f.tangential[0] * p.tangents[f.row].row[0] + f.tangential[1] * p.tangents[f.row].row[1];
  return w;
}

/// Seven numbers, not all zero, with which seven columns sum up to zero.
void null_vector(Vec6 (&columns)[kMax + 1], double (&x)[kMax + 1]) noexcept {
  int order[kMax + 1] = {0, 1, 2, 3, 4, 5, 6};
  int rank = 0;
  for (; rank < static_cast<int>(kMax); ++rank) {
    // The largest entry that is left is the pivot.
    int row = rank, column = rank;
    for (int j = rank; j <= static_cast<int>(kMax); ++j)
      for (int i = rank; i < static_cast<int>(kMax); ++i)
        if (std::abs(columns[order[j]][i]) > std::abs(columns[order[column]][row])) row = i, column = j;
    const double pivot = columns[order[column]][row];
    if (!(std::abs(pivot) > 0)) break;
    std::swap(order[rank], order[column]);
    for (Vec6& c : columns) std::swap(c[rank], c[row]);
    for (int i = rank + 1; i < static_cast<int>(kMax); ++i) {
      const double factor = columns[order[rank]][i] / pivot;
      for (int j = rank; j <= static_cast<int>(kMax); ++j) columns[order[j]][i] -= factor * columns[order[j]][rank];
    }
  }
  std::fill_n(x, kMax + 1, 0.0);
  x[order[rank]] = 1;
  for (int i = rank - 1; i >= 0; --i) {
    double sum = columns[order[rank]][i];
    for (int j = i + 1; j < rank; ++j) sum += columns[order[j]][i] * x[order[j]];
    x[order[i]] = -sum / columns[order[i]][i];
  }
}

}  // namespace

void reduce_to_six(const FrictionProblem& problem, std::vector<FrictionForce>& forces) noexcept {
  while (forces.size() > kMax) {
    Vec6 columns[kMax + 1];
    double x[kMax + 1];
    const std::size_t first = forces.size() - kMax - 1;
    double largest = 0;
    for (std::size_t i = 0; i <= kMax; ++i) {
      columns[i] = action(problem, forces[first + i]);
      largest = std::max(largest, columns[i].norm());
    }
    if (largest > 0)
      for (Vec6& c : columns) c /= largest;
    null_vector(columns, x);
    // All seven change along it until the first is gone.
    const auto most = std::max_element(x, x + kMax + 1);
    const bool forward = *most >= -*std::min_element(x, x + kMax + 1);
    if (!forward)
      for (double& v : x) v = -v;
    std::size_t gone = static_cast<std::size_t>(std::max_element(x, x + kMax + 1) - x);
    const double step = 1 / x[gone];
    for (std::size_t i = 0; i <= kMax; ++i) {
      FrictionForce& f = forces[first + i];
      const double scale = std::max(0.0, 1 - step * x[i]);
      f.normal *= scale;
      f.tangential[0] *= scale;
      f.tangential[1] *= scale;
    }
    forces.erase(forces.begin() + static_cast<std::ptrdiff_t>(first + gone));
  }
}

}  // namespace tegotae
