#include "narrowphase/face_columns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tegotae {
namespace {

/// Faces that a cell holds in the mean, if none were in two, and cells along an axis at most.
constexpr double kFacesPerCell = 1, kMostCells = 4096;
/// Cells in which a face is listed, at most in the mean.
constexpr double kMostListed = 12;
/// Faces are taken to be larger by this share of the whole grid: points near their edges are asked about as well.
constexpr double kSlack = 1e-6;

}  // namespace

FaceColumns::FaceColumns(const PatchTree& tree, const Vec3& axis, const std::vector<std::uint32_t>& faces) {
  if (faces.empty()) return;
  across_[0] = axis.unitOrthogonal();
  across_[1] = axis.cross(across_[0]);
  struct Extent {
    Place low, high;
  };
  const auto extent_of = [&](std::uint32_t face) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    Extent out{{kFar, kFar}, {-kFar, -kFar}};
    for (int c = 0; c < 3; ++c) {
      const Place at = place_of(tree.corner(face, c) - tree.origin());
      for (std::size_t i = 0; i < 2; ++i) {
        out.low[i] = std::min(out.low[i], at[i]);
        out.high[i] = std::max(out.high[i], at[i]);
      }
    }
    return out;
  };
  low_ = extent_of(faces[0]).low;
  high_ = extent_of(faces[0]).high;
  for (const std::uint32_t face : faces) {
    const Extent extent = extent_of(face);
    for (std::size_t i = 0; i < 2; ++i) {
      low_[i] = std::min(low_[i], extent.low[i]);
      high_[i] = std::max(high_[i], extent.high[i]);
    }
  }
  const double slack = kSlack * std::max(high_[0] - low_[0], high_[1] - low_[1]);
  for (std::size_t i = 0; i < 2; ++i) {
    low_[i] -= slack;
    high_[i] += slack;
  }
  double side =
      std::sqrt(kFacesPerCell * (high_[0] - low_[0]) * (high_[1] - low_[1]) / static_cast<double>(faces.size()));
  // Needles and large faces among small ones are in many cells: in fewer, where those are larger.
  for (double listed = kMostListed + 1; listed > kMostListed; side *= 2) {
    for (std::size_t i = 0; i < 2; ++i) {
      const double cells = std::clamp((high_[i] - low_[i]) / side, 1.0, kMostCells);
      cells_[i] = static_cast<std::uint32_t>(cells);
      size_[i] = (high_[i] - low_[i]) / cells_[i];
    }
    listed = 0;
    for (const std::uint32_t face : faces) {
      const Extent extent = extent_of(face);
      const auto span = [&](std::size_t i) {
        return 1.0 + cell_of(extent.high[i] + slack, i) - cell_of(extent.low[i] - slack, i);
      };
      listed += span(0) * span(1) / static_cast<double>(faces.size());
    }
    if (cells_[0] == 1 && cells_[1] == 1) break;
  }
  // How many each cell holds, then which.
  first_.assign(std::size_t{cells_[0]} * cells_[1] + 1, 0);
  const auto for_cells = [&](std::uint32_t face, const auto& take) {
    const Extent extent = extent_of(face);
    for (std::uint32_t v = cell_of(extent.low[1] - slack, 1); v <= cell_of(extent.high[1] + slack, 1); ++v)
      for (std::uint32_t u = cell_of(extent.low[0] - slack, 0); u <= cell_of(extent.high[0] + slack, 0); ++u)
        take(std::size_t{v} * cells_[0] + u);
  };
  for (const std::uint32_t face : faces) for_cells(face, [&](std::size_t cell) { ++first_[cell + 1]; });
  for (std::size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
  faces_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (const std::uint32_t face : faces) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (int c = 0; c < 3; ++c) {
      const double along = (tree.corner(face, c) - tree.origin()).dot(axis);
      low = std::min(low, along - slack);
      high = std::max(high, along + slack);
    }
    const Face told = {static_cast<float>(low), static_cast<float>(high), face};
    for_cells(face, [&](std::size_t cell) { faces_[next[cell]++] = told; });
    all_ = {std::min(all_.low, told.low), std::max(all_.high, told.high)};
  }
}

std::uint32_t FaceColumns::cell_of(double at, std::size_t i) const {
  return static_cast<std::uint32_t>(std::clamp((at - low_[i]) / size_[i], 0.0, cells_[i] - 1.0));
}

FaceColumns::Faces FaceColumns::beside(const Vec3& p) const noexcept {
  const Place at = place_of(p);
  for (std::size_t i = 0; i < 2; ++i)
    if (cells_[i] == 0 || !(at[i] >= low_[i] && at[i] <= high_[i])) return {nullptr, nullptr};
  const std::size_t cell = std::size_t{cell_of(at[1], 1)} * cells_[0] + cell_of(at[0], 0);
  return {faces_.data() + first_[cell], faces_.data() + first_[cell + 1]};
}

}  // namespace tegotae
