#include "narrowphase/slab.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "narrowphase/face_gaps.hpp"

namespace tegotae {
namespace {

/// Of a ball in single precision, as a share of all coordinates.
constexpr double kRadiusError = 1e-6;

}  // namespace

SlabLanes::SlabLanes(const Slab* slabs, std::size_t count) {
  Vec3 low = slabs[0].center, high = low;
  for (std::size_t i = 0; i < count; ++i) {
    low = low.cwiseMin(slabs[i].center);
    high = high.cwiseMax(slabs[i].center);
  }
  origin = 0.5 * (low + high);
  for (std::size_t k = 0; k < FaceBlocks::kFan; ++k) {
    const Slab& slab = slabs[std::min(k, count - 1)];
    const Float3 at = in_single(slab.center - origin), across = in_single(slab.axes.col(2));
    for (std::size_t i = 0; i < 3; ++i) {
      center[i][k] = at[i];
      normal[i][k] = across[i];
      const auto axis = static_cast<Eigen::Index>(i);
      const Float3 side = in_single(slab.half[axis] * slab.axes.col(axis));
      for (std::size_t c = 0; c < 3; ++c) sides[i][c][k] = side[c];
    }
    thickness[k] = static_cast<float>(slab.half.z());
    size = std::max(size, static_cast<float>((slab.center - origin).lpNorm<1>() + slab.half.sum()));
  }
}

double SlabLanes::radius(std::uint32_t k) const noexcept {
  double square = 0;
  for (const auto& side : sides)
    for (const Field& along : side) square += double{along[k]} * double{along[k]};
  return std::sqrt(square) + kRadiusError * size;
}

SlabEnds::SlabEnds(const MovedSlab& a, const Vec3& origin)
    : center{in_single(a.from - origin), in_single(a.to - origin)}, normal(in_single(a.axes.col(2))), size(0) {
  for (std::size_t k = 0; k < 2; ++k) {
    float sum = sum_of_sizes(center[k]);
    for (std::size_t i = 0; i < 3; ++i) {
      sides[k][i] = in_single((k == 0 ? a.from_axes : a.to_axes).col(static_cast<Eigen::Index>(i)));
      sum += sum_of_sizes(sides[k][i]);
    }
    size = std::max(size, sum);
  }
}

MovedBox MovedSlab::corners(const Vec3& origin) const {
  std::array<Vec3, 8> start, end;
  for (unsigned i = 0; i < 8; ++i) {
    const Vec3 side((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
    start[i] = from + from_axes * side - origin;
    end[i] = to + to_axes * side - origin;
  }
  return MovedBox(start, end);
}

double apart_for(const MovedSlab& a, const Slab& b, double floor) noexcept {
  double best = 0;
  const auto look_along = [&](const Vec3& n) {
    const double reach = (n.transpose() * b.axes).cwiseAbs().dot(b.half) + floor;
    const double start = n.dot(a.from - b.center), end = n.dot(a.to - b.center);
    const double least = (n.transpose() * a.from_axes).cwiseAbs().sum() + reach;
    const double then = (n.transpose() * a.to_axes).cwiseAbs().sum() + reach;
    // From B's slab to A's, on the side where A is.
    const double side = start < 0 ? -1 : 1, before = side * start - least, after = side * end - then;
    if (before >= 0) best = std::max(best, after >= 0 ? 1 : before / (before - after));
  };
  look_along(b.axes.col(2));
  for (int i = 2; i >= 0 && best < 1; --i) look_along(a.axes.col(i));
  for (int i = 0; i < 2 && best < 1; ++i) look_along(b.axes.col(i));
  return best;
}

}  // namespace tegotae
