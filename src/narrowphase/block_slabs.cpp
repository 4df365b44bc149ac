#include "narrowphase/block_slabs.hpp"

#include <algorithm>
#include <cmath>

#include "core/numbers.hpp"
#include "narrowphase/face_gaps.hpp"

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

/// The center of a MovedSlab at both ends, from the point that eight others are from.
typedef std::array<Float3, 2> Ends;

float sum_of_sizes(const Float3& x) {
  return std::abs(x[0]) + std::abs(x[1]) + std::abs(x[2]);
}

TEGOTAE_INLINE Lane all_of(const SlabLanes::Field& field) {
  static_assert(FaceBlocks::kFan == kLane);
  return *reinterpret_cast<const Lane*>(field.data());
}

TEGOTAE_INLINE Lanes3 all_of(const std::array<SlabLanes::Field, 3>& f) {
  return {all_of(f[0]), all_of(f[1]), all_of(f[2])};
}

TEGOTAE_INLINE Lane size_of(Lane x) {
  return greater(x, -x);
}

TEGOTAE_INLINE float size_along(const Float3& n, const std::array<Float3, 3>& sides) {
  return std::abs(dot(n, sides[0])) + std::abs(dot(n, sides[1])) + std::abs(dot(n, sides[2]));
}

TEGOTAE_INLINE Lane along(const Lanes3& n, const Float3& x) {
  return n.x * x[0] + n.y * x[1] + n.z * x[2];
}

TEGOTAE_WIDE std::uint32_t apart_of(const Ends& at, const SlabSides& a, const SlabLanes& b, float floor) {
  const Lanes3 center = all_of(b.center), normal = all_of(b.normal);
  Lane thickness = all_of(b.thickness) + floor;
  // Across B's faces, then across A's.
  const Lane middle = normal.x * center.x + normal.y * center.y + normal.z * center.z;
  Lane off[2], most[2];
  for (std::size_t k = 0; k < 2; ++k) {
    off[k] = along(normal, at[k]) - middle;
    most[k] = size_of(along(normal, a.sides[k][0])) + size_of(along(normal, a.sides[k][1])) +
              size_of(along(normal, a.sides[k][2])) + thickness;
  }
  LaneBits apart = ((off[0] >= most[0]) & (off[1] >= most[1])) | ((-off[0] >= most[0]) & (-off[1] >= most[1]));
  const Lane of_center = dot(center, a.normal);
  thickness = Lane{} + floor;
  for (const auto& side : b.sides) thickness += size_of(dot(all_of(side), a.normal));
  for (std::size_t k = 0; k < 2; ++k) {
    off[k] = dot(a.normal, at[k]) - of_center;
    most[k] = thickness + size_along(a.normal, a.sides[k]);
  }
  apart |= ((off[0] >= most[0]) & (off[1] >= most[1])) | ((-off[0] >= most[0]) & (-off[1] >= most[1]));
  constexpr LaneBits kOf = {1, 2, 4, 8, 16, 32, 64, 128};
  return together(apart & kOf);
}

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

BlockSlabs::BlockSlabs(const PatchTree& tree, const FaceBlocks& blocks) {
  std::uint32_t each = 1;
  for (std::uint32_t level = 0; level < std::min(kLevels, blocks.levels()); ++level, each *= FaceBlocks::kFan) {
    slabs_.emplace_back();
    for (std::uint32_t first = 0; first < blocks.count(); first += each)
      slabs_.back().push_back(slab_about(corners_of(tree, blocks, first, std::min(first + each, blocks.count()))));
    for (Slab& slab : slabs_.back()) slab.half += Vec3::Constant(kSlabError * tree.radius());
    lanes_.emplace_back();
    const std::size_t count = slabs_.back().size();
    for (std::size_t first = 0; first < count; first += FaceBlocks::kFan)
      lanes_.back().emplace_back(&slabs_.back()[first], std::min<std::size_t>(FaceBlocks::kFan, count - first));
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

SlabSides::SlabSides(const MovedSlab& a) : normal(in_single(a.axes.col(2))), size(0) {
  for (std::size_t k = 0; k < 2; ++k) {
    float sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      sides[k][i] = in_single((k == 0 ? a.from_axes : a.to_axes).col(static_cast<Eigen::Index>(i)));
      sum += sum_of_sizes(sides[k][i]);
    }
    size = std::max(size, sum);
  }
}

std::uint32_t kept_apart(const MovedSlab& a, const SlabSides& sides, const SlabLanes& b, double floor) noexcept {
  const Ends at = {in_single(a.from - b.origin), in_single(a.to - b.origin)};
  const float size = sides.size + b.size + std::max(sum_of_sizes(at[0]), sum_of_sizes(at[1]));
  return apart_of(at, sides, b, static_cast<float>(floor) + kGapError * size);
}

}  // namespace tegotae
