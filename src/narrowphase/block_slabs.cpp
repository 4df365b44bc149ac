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

TEGOTAE_INLINE float size_along(const Float3& n, const std::array<Float3, 3>& sides) {
  return std::abs(dot(n, sides[0])) + std::abs(dot(n, sides[1])) + std::abs(dot(n, sides[2]));
}

TEGOTAE_INLINE Lane along(const Lanes3& n, const Float3& x) {
  return n.x * x[0] + n.y * x[1] + n.z * x[2];
}

/// As kept_apart(): `shift` is the origin of `a` from that of `b`, m.
TEGOTAE_INLINE std::uint32_t apart_of(const SlabEnds& a, const SlabLanes& b, const Float3& shift, float floor_of_all) {
  const float floor = floor_of_all + kGapError * (a.size + b.size + sum_of_sizes(shift));
  std::array<Float3, 2> at;
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t i = 0; i < 3; ++i) at[k][i] = a.center[k][i] + shift[i];
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
  return together(apart & kEachBit);
}

TEGOTAE_WIDE std::uint32_t apart_of_eight(const SlabEnds& a, const SlabLanes& b, const Float3& shift, float floor) {
  return apart_of(a, b, shift, floor);
}

TEGOTAE_WIDE std::uint32_t not_apart_under(const std::uint32_t* nodes, std::uint32_t count,
                                           std::uint32_t level_of_nodes, const FaceBlocks& blocks,
                                           const BlockSlabs& slabs, const SlabEnds& a, const Vec3& origin,
                                           const AxisBox& box, float floor, std::uint32_t* out, std::uint32_t most) {
  std::uint32_t found = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t bits = overlap(blocks.boxes_below(level_of_nodes - 1, nodes[i]), box);
    if (bits == 0) continue;
    const SlabLanes& b = slabs.lanes(level_of_nodes - 1, nodes[i]);
    bits &= ~apart_of(a, b, in_single(origin - b.origin), floor);
    for (; bits != 0; bits &= bits - 1) {
      if (found == most) return most + 1;
      out[found++] = FaceBlocks::kFan * nodes[i] + static_cast<std::uint32_t>(__builtin_ctz(bits));
    }
  }
  return found;
}

/// A rotation in single precision, row by row, and where a point comes to.
struct Turn {
  std::array<Float3, 3> rows;
  Float3 to;

  Turn(const Mat3& R, const Vec3& at) : to(in_single(at)) {
    for (std::size_t i = 0; i < 3; ++i) rows[i] = in_single(R.row(static_cast<Eigen::Index>(i)));
  }
};

TEGOTAE_WIDE void move_slabs(const SlabLanes& a, const std::array<Turn, 2>& turns, MovedSlabs& out) {
  const Lanes3 center = all_of(a.center), normal = all_of(a.normal);
  for (std::size_t i = 0; i < 3; ++i) store8(out.normal[i], dot(normal, turns[0].rows[i]));
  Lane size{};
  for (std::size_t k = 0; k < 2; ++k) {
    Lane sum{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Float3& row = turns[k].rows[i];
      const Lane at = dot(center, row) + turns[k].to[i];
      Lane reach{};
      for (std::size_t c = 0; c < 3; ++c) {
        const Lane side = dot(all_of(a.sides[c]), row);
        store8(out.sides[k][c][i], side);
        reach += size_of(side);
      }
      store8(out.center[k][i], at);
      sum += size_of(at) + reach;
      const Lane low = at - reach, high = at + reach;
      store8(out.low[i], k == 0 ? low : lesser(low, all_of(out.low[i])));
      store8(out.high[i], k == 0 ? high : greater(high, all_of(out.high[i])));
    }
    size = greater(size, sum);
  }
  store8(out.size, size);
}

}  // namespace

BlockSlabs::BlockSlabs(const PatchTree& tree, const FaceBlocks& blocks) {
  std::uint32_t each = 1;
  for (std::uint32_t level = 0; level < std::min(kLevels, blocks.levels()); ++level, each *= FaceBlocks::kFan) {
    slabs_.emplace_back();
    std::vector<std::optional<Quadric>> quadrics;
    for (std::uint32_t first = 0; first < blocks.count(); first += each) {
      const std::vector<Vec3> corners = corners_of(tree, blocks, first, std::min(first + each, blocks.count()));
      Slab slab = slab_about(corners);
      slab.half += Vec3::Constant(kSlabError * tree.radius());
      slabs_.back().push_back(slab);
      quadrics.push_back(quadric_of(corners, slab));
    }
    lanes_.emplace_back();
    quadrics_.emplace_back();
    const std::size_t count = slabs_.back().size();
    for (std::size_t first = 0; first < count; first += FaceBlocks::kFan) {
      const std::size_t together = std::min<std::size_t>(FaceBlocks::kFan, count - first);
      lanes_.back().emplace_back(&slabs_.back()[first], together);
      quadrics_.back().emplace_back(&slabs_.back()[first], &quadrics[first], together);
    }
  }
}

void MovedSlabs::set(const SlabLanes& a, const Placement& start, const Placement& end) noexcept {
  const Vec3 from = start.R * a.origin + start.t, to = end.R * a.origin + end.t;
  origin = 0.5 * (from + to);
  move_slabs(a, {Turn(start.R, from - origin), Turn(end.R, to - origin)}, *this);
}

SlabEnds MovedSlabs::slab(std::uint32_t k) const noexcept {
  SlabEnds out;
  for (std::size_t i = 0; i < 3; ++i) {
    out.normal[i] = normal[i][k];
    for (std::size_t end = 0; end < 2; ++end) {
      out.center[end][i] = center[end][i][k];
      for (std::size_t c = 0; c < 3; ++c) out.sides[end][c][i] = sides[end][c][i][k];
    }
  }
  out.size = size[k];
  return out;
}

AxisBox MovedSlabs::box(std::uint32_t k, double slack) const noexcept {
  AxisBox out;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto at = static_cast<float>(origin[static_cast<Eigen::Index>(i)]);
    const float more = static_cast<float>(slack) + kBoxError * (std::abs(at) + size[k]);
    out.low[i] = at + low[i][k] - more;
    out.high[i] = at + high[i][k] + more;
  }
  return out;
}

std::uint32_t kept_apart(const SlabEnds& a, const Vec3& origin, const SlabLanes& b, double floor) noexcept {
  return apart_of_eight(a, b, in_single(origin - b.origin), static_cast<float>(floor));
}

std::uint32_t not_kept_apart_under(const std::uint32_t* nodes, std::uint32_t count, std::uint32_t level_of_nodes,
                                   const FaceBlocks& blocks, const BlockSlabs& slabs, const SlabEnds& a,
                                   const Vec3& origin, const AxisBox& box, double floor, std::uint32_t* out,
                                   std::uint32_t most) noexcept {
  return not_apart_under(nodes, count, level_of_nodes, blocks, slabs, a, origin, box, static_cast<float>(floor), out,
                         most);
}

}  // namespace tegotae
