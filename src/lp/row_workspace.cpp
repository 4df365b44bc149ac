#include "lp/row_workspace.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tegotae {

RowWorkspace::RowWorkspace(int capacity) : pricing_(pricing()), capacity_(capacity) {
  const auto blocks = static_cast<std::size_t>((capacity + kRowLanes - 1) / kRowLanes);
  for (auto* array : {&d_, &inverse_norm_, &row_scale_, &column_scale_, &step_, &pivot_}) {
    array->resize(blocks);
  }
}

RowWorkspace::Input RowWorkspace::load(const LowRankMatrix& g, const double* d, const Vec6& shift) noexcept {
  if (g.rows() > capacity_) {
    return Input::bad;
  }
  g_ = &g;
  count_ = g.rows();
  blocks_ = (count_ + kRowLanes - 1) / kRowLanes;
  zero_row_ = -1;
  largest_ = 0;
  pricing_.inverse_norms(g.blocks(), blocks_, inverse_norm_.data());
  const bool shifted = !shift.isZero(0);
  for (int i = 0; i < blocks_ * kRowLanes; ++i) {
    // Rows of padding get scale 0, which keeps them out of every choice; so do zero rows, which no motion changes.
    double scale = 0;
    double rest = 0;
    if (i < count_) {
      rest = shifted ? d[i] - g.row(i).dot(shift) : d[i];
      scale = inverse_norm(i);
      if (!(scale > 0) || !std::isfinite(rest)) {
        return Input::bad;
      }
      if (scale > std::numeric_limits<double>::max()) {
        scale = 0;
        if (rest > 0 && zero_row_ < 0) {
          zero_row_ = i;
        }
      }
    }
    at(d_, i) = rest;
    at(inverse_norm_, i) = at(row_scale_, i) = at(column_scale_, i) = scale;
    largest_ = std::max(largest_, rest * scale);
  }
  return zero_row_ >= 0 ? Input::infeasible : Input::good;
}

RowChoice RowWorkspace::most_violated(const Vec6& x) const noexcept {
  return pricing_.most_violated(g_->blocks(), d_.data(), row_scale_.data(), blocks_, x.data());
}

RowChoice RowWorkspace::first_violated(const Vec6& x, double tolerance) const noexcept {
  for (int i = 0; i < count_; ++i) {
    const double violation = (d(i) - g_->row(i).dot(x)) * at(row_scale_, i);
    if (violation > tolerance) {
      return {i, violation};
    }
  }
  return {};
}

double RowWorkspace::bound_steps(const Vec6& u, const Vec6& v, double min_pivot, double slack) noexcept {
  return pricing_.steps(g_->blocks(), column_scale_.data(), blocks_, u.data(), v.data(), min_pivot, slack, step_.data(),
                        pivot_.data());
}

RowChoice RowWorkspace::largest_pivot(double bound) const noexcept {
  return pricing_.largest_pivot(step_.data(), pivot_.data(), blocks_, bound);
}

RowChoice RowWorkspace::first_step(double bound) const noexcept {
  for (int j = 0; j < count_; ++j) {
    if (step(j) <= bound) {
      return {j, at(pivot_, j)};
    }
  }
  return {};
}

}  // namespace tegotae
