#include "narrowphase/block_slabs.hpp"

#include <algorithm>
#include <cmath>

#include "core/numbers.hpp"

namespace tegotae {
namespace {

/// Slabs are grown by this share of their coordinates, for rounding.
constexpr double kSlabError = 1e-12;
/// Faces of which edges are tried as the direction of a slab.
constexpr std::size_t kEdgesTried = 8;

/// The corners of faces in a row.
std::vector<Vec3> corners_of(const PatchTree& tree, const FaceBlocks& blocks, std::uint32_t first, std::uint32_t end) {
  std::vector<Vec3> corners;
  for (std::uint32_t block = first; block < end; ++block)
    for (std::uint32_t k = 0; k < blocks.faces(block); ++k)
      for (int c = 0; c < 3; ++c) corners.push_back(tree.corner(blocks.face(block, k), c) - tree.origin());
  return corners;
}

/// Across most of the area; a sheet may have faces that look either way.
Vec3 direction_across(const std::vector<Vec3>& corners) {
  Vec3 across = Vec3::Zero();
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    const Vec3 normal = (corners[i + 1] - corners[i]).cross(corners[i + 2] - corners[i]);
    across += across.dot(normal) < 0 ? -normal : normal;
  }
  const Vec3 n = across.stableNormalized();
  return std::abs(n.norm() - 1) < 0.1 ? n : Vec3::UnitZ();
}

Slab slab_with(const std::vector<Vec3>& corners, const Mat3& axes) {
  Vec3 low = Vec3::Constant(kInfinity), high = -low;
  for (const Vec3& corner : corners) {
    const Vec3 at = axes.transpose() * corner;
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  return {axes * (0.5 * (low + high)), axes, 0.5 * (high - low)};
}

/// About the corners, along the edge that makes it smallest.
Slab slab_about(const std::vector<Vec3>& corners) {
  const Vec3 n = direction_across(corners);
  const std::size_t stride = 3 * (corners.size() / (3 * kEdgesTried) + 1);
  const auto area = [](const Slab& s) { return s.half.x() * s.half.y(); };
  Mat3 axes;
  axes.col(2) = n;
  axes.col(0) = n.unitOrthogonal();
  axes.col(1) = n.cross(axes.col(0));
  Slab best = slab_with(corners, axes);
  for (std::size_t i = 0; i < corners.size(); i += stride) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 edge = corners[i + (k + 1) % 3] - corners[i + k], along = edge - n.dot(edge) * n;
      if (!(along.norm() > 0.1 * edge.norm())) continue;
      axes.col(0) = along.normalized();
      axes.col(1) = n.cross(axes.col(0)).normalized();
      const Slab slab = slab_with(corners, axes);
      if (area(slab) < area(best)) best = slab;
    }
  }
  return best;
}

}  // namespace

BlockSlabs::BlockSlabs(const PatchTree& tree, const FaceBlocks& blocks) {
  std::uint32_t each = 1;
  for (std::uint32_t level = 0; level < std::min(kLevels, blocks.levels()); ++level, each *= FaceBlocks::kFan) {
    slabs_.emplace_back();
    for (std::uint32_t first = 0; first < blocks.count(); first += each)
      slabs_.back().push_back(slab_about(corners_of(tree, blocks, first, std::min(first + each, blocks.count()))));
    for (Slab& slab : slabs_.back()) slab.half += Vec3::Constant(kSlabError * tree.radius());
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
