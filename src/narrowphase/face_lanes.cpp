#include "narrowphase/face_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "narrowphase/face_gaps.hpp"

namespace tegotae {
namespace {

TEGOTAE_WIDE std::uint32_t below(const OneFace& a, const FaceLanes& b, const Float3& shift, float floor) {
  return gaps_below(a, Along{}, b, shift, floor);
}

TEGOTAE_WIDE std::uint32_t below(const OneBox& a, const FaceLanes& b, const Float3& shift, float floor) {
  return gaps_below(a, Along{}, b, shift, floor);
}

/// A Placement in single precision.
struct Moved {
  std::array<Float3, 3> R;  ///< rows
  Float3 t;
};

Moved in_single(const Placement& at) {
  Moved out;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t k = 0; k < 3; ++k) out.R[i][k] = static_cast<float>(at.R(row, static_cast<Eigen::Index>(k)));
    out.t[i] = static_cast<float>(at.t[row]);
  }
  return out;
}

/// Of unit length, about; zero where they cancel out.
Float3 mean_of(const std::array<FaceLanes::Field, 3>& normals) {
  Float3 sum{};
  for (std::size_t i = 0; i < 3; ++i)
    for (const float x : normals[i]) sum[i] += x;
  const float square = sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2];
  if (!(square > 0.01F)) return {0, 0, 0};
  const float scale = 1 / std::sqrt(square);
  return {scale * sum[0], scale * sum[1], scale * sum[2]};
}

TEGOTAE_INLINE float least(Lane lanes) {
  float out = lanes[0];
  for (std::uint32_t k = 1; k < kLane; ++k) out = std::min(out, lanes[k]);
  return out;
}

TEGOTAE_WIDE void move_lanes(const FaceLanes& faces, const Moved& start, const Moved& end, MovedLanes& out) {
  for (std::size_t i = 0; i < 3; ++i) out.mean[i] = dot(faces.mean, start.R[i]);
  Lane mean_low{}, mean_high{}, size{};
  for (std::uint32_t first = 0; first < kBlockFaces; first += kLane) {
    const Lanes3 n = load3(faces.normal, first);
    const Lanes3 normal = {dot(n, start.R[0]), dot(n, start.R[1]), dot(n, start.R[2])};
    store3(out.normal, first, normal);
    Lanes3 low{}, high{};
    Lane along_low{}, along_high{};
    for (std::size_t c = 0; c < 6; ++c) {
      const Moved& at = c < 3 ? start : end;
      const Lanes3 p = load3(faces.corner[c % 3], first);
      const Lanes3 x = {dot(p, at.R[0]) + at.t[0], dot(p, at.R[1]) + at.t[1], dot(p, at.R[2]) + at.t[2]};
      const Lane along = normal.x * x.x + normal.y * x.y + normal.z * x.z;
      along_low = c == 0 ? along : lesser(along_low, along);
      along_high = c == 0 ? along : greater(along_high, along);
      low = c == 0 ? x : Lanes3{lesser(low.x, x.x), lesser(low.y, x.y), lesser(low.z, x.z)};
      high = c == 0 ? x : Lanes3{greater(high.x, x.x), greater(high.y, x.y), greater(high.z, x.z)};
      store3(out.corner[c], first, x);
      const Lane up = dot(x, out.mean);
      mean_low = first + c == 0 ? up : lesser(mean_low, up);
      mean_high = first + c == 0 ? up : greater(mean_high, up);
    }
    for (const Lane& x : {low.x, low.y, low.z}) size = greater(size, -x);
    for (const Lane& x : {high.x, high.y, high.z}) size = greater(size, x);
    store(out.normal_low, first, along_low);
    store(out.normal_high, first, along_high);
    store3(out.low, first, low);
    store3(out.high, first, high);
  }
  out.mean_low = least(mean_low);
  out.mean_high = -least(-mean_high);
  // What they were before counts as well.
  out.size = std::max(-least(-size), faces.size);
}

TEGOTAE_WIDE AxisBox box_of(const MovedLanes& faces, std::uint32_t skipped) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  AxisBox box;
  for (std::size_t i = 0; i < 3; ++i) {
    Lane low = Lane{} + kFar, high = Lane{} - kFar;
    for (std::uint32_t first = 0; first < kBlockFaces; first += kLane) {
      const LaneBits without = (static_cast<std::int32_t>(skipped >> first) & kEachBit) != 0;
      low = without ? low : lesser(low, load(faces.low[i], first));
      high = without ? high : greater(high, load(faces.high[i], first));
    }
    box.low[i] = least(low);
    box.high[i] = -least(-high);
  }
  return box;
}

/// Directions across edges: of each with each, and across those of both faces in their planes; one is there twice.
constexpr std::uint32_t kAcross = 16;
typedef std::array<FaceLanes::Field, 3> Across;
static_assert(kAcross == kBlockFaces);

/// One of eight directions along which there is at least `floor`; none: kAcross.
TEGOTAE_INLINE std::uint32_t one_apart(const Across& left, const Across& right, std::uint32_t first,
                                       const std::array<Float3, 6>& p, const std::array<Float3, 3>& q, float floor2) {
  const Lanes3 l = load3(left, first), r = load3(right, first);
  const Lanes3 n = {l.y * r.z - l.z * r.y, l.z * r.x - l.x * r.z, l.x * r.y - l.y * r.x};
  Lane low = dot(n, p[0]), high = low;
  for (std::size_t k = 1; k < 6; ++k) {
    const Lane x = dot(n, p[k]);
    low = lesser(low, x);
    high = greater(high, x);
  }
  const Lane x = dot(n, q[0]), y = dot(n, q[1]), z = dot(n, q[2]);
  const Lane gap = greater(low - greater(greater(x, y), z), lesser(lesser(x, y), z) - high);
  const Lane positive = greater(gap, Lane{}), square = positive * positive;
  // Squares below are too near to the least numbers of single precision.
  const Lane least = greater((n.x * n.x + n.y * n.y + n.z * n.z) * floor2, Lane{} + 1e-36F);
  const LaneBits apart = square > least;
  if (together(apart) == 0) return kAcross;
  std::uint32_t k = 0;
  while (apart[k] == 0) ++k;
  return first + k;
}

TEGOTAE_WIDE std::uint32_t across_edges(const Across& left, const Across& right, const std::array<Float3, 6>& p,
                                        const std::array<Float3, 3>& q, float floor2) {
  const std::uint32_t one = one_apart(left, right, 0, p, q, floor2);
  return one < kAcross ? one : one_apart(left, right, kLane, p, q, floor2);
}

Float3 difference(const Float3& x, const Float3& y) {
  return {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
}

/// Across both, of unit length, about; zero where there is no such direction. Any will do that keeps faces apart.
Float3 across(const Float3& x, const Float3& y) {
  const Float3 n = {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
  const float square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
  if (!(square > std::numeric_limits<float>::min())) return {0, 0, 0};
  const float scale = 1 / std::sqrt(square);
  return {scale * n[0], scale * n[1], scale * n[2]};
}

Float3 normal_of(const Float3& p, const Float3& q, const Float3& r) {
  return across(difference(q, p), difference(r, p));
}

}  // namespace

FaceLanes::FaceLanes(const PatchTree& tree, const FaceBlocks& blocks, std::uint32_t block) {
  const AxisBox box = blocks.box(0, block);
  for (std::size_t i = 0; i < 3; ++i)
    origin[static_cast<Eigen::Index>(i)] = 0.5 * (double{box.low[i]} + double{box.high[i]});
  for (std::uint32_t k = 0; k < kBlockFaces; ++k) {
    const std::uint32_t face = blocks.face(block, std::min(k, blocks.faces(block) - 1));
    std::array<Float3, 3> p;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 at = tree.corner(face, static_cast<int>(c)) - tree.origin() - origin;
      p[c] = {static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z())};
    }
    const Float3 n = normal_of(p[0], p[1], p[2]);
    Float3 along{};
    for (std::size_t i = 0; i < 3; ++i) {
      normal[i][k] = n[i];
      for (std::size_t c = 0; c < 3; ++c) {
        corner[c][i][k] = p[c][i];
        along[c] += n[i] * p[c][i];
      }
      size = std::max({size, std::abs(p[0][i]), std::abs(p[1][i]), std::abs(p[2][i])});
    }
    normal_low[k] = std::min({along[0], along[1], along[2]});
    normal_high[k] = std::max({along[0], along[1], along[2]});
  }
  mean = mean_of(normal);
  for (std::size_t c = 0; c < 3; ++c)
    for (std::uint32_t k = 0; k < kBlockFaces; ++k) {
      const float along = mean[0] * corner[c][0][k] + mean[1] * corner[c][1][k] + mean[2] * corner[c][2][k];
      mean_low = c + k == 0 ? along : std::min(mean_low, along);
      mean_high = c + k == 0 ? along : std::max(mean_high, along);
    }
}

void MovedLanes::set(const FaceLanes& faces, const Placement& start, const Placement& end) noexcept {
  move_lanes(faces, in_single(start), in_single(end), *this);
}

AxisBox MovedLanes::box_without(std::uint32_t skipped) const noexcept {
  return box_of(*this, skipped);
}

MovedBox::MovedBox(const std::array<Vec3, 8>& start, const std::array<Vec3, 8>& end) {
  size = 0;
  for (std::size_t c = 0; c < 8; ++c) {
    corner[c] = {static_cast<float>(start[c].x()), static_cast<float>(start[c].y()), static_cast<float>(start[c].z())};
    corner[8 + c] = {static_cast<float>(end[c].x()), static_cast<float>(end[c].y()), static_cast<float>(end[c].z())};
  }
  normal = normal_of(corner[0], corner[1], corner[2]);
  low = high = corner[0];
  for (std::size_t c = 0; c < 16; ++c) {
    const float along = normal[0] * corner[c][0] + normal[1] * corner[c][1] + normal[2] * corner[c][2];
    normal_low = c == 0 ? along : std::min(normal_low, along);
    normal_high = c == 0 ? along : std::max(normal_high, along);
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], corner[c][i]);
      high[i] = std::max(high[i], corner[c][i]);
    }
  }
  for (std::size_t i = 0; i < 3; ++i) size = std::max({size, -low[i], high[i]});
}

std::uint32_t not_kept_apart(const MovedLanes& a, std::uint32_t k, const FaceLanes& b, const Vec3& shift,
                             double floor) noexcept {
  return below(OneFace{a, k}, b, in_single(shift), floor_in_single(a.size, b, shift, floor));
}

std::uint32_t not_kept_apart(const MovedBox& a, const FaceLanes& b, const Vec3& shift, double floor) noexcept {
  return below(OneBox{a}, b, in_single(shift), floor_in_single(a.size, b, shift, floor));
}

bool edges_keep_apart(const MovedLanes& a, std::uint32_t k, const FaceLanes& b, std::uint32_t k_b, const Vec3& shift,
                      double floor, Float3& direction) noexcept {
  std::array<Float3, 6> p;
  std::array<Float3, 3> q;
  Float3 normal_a, normal_b;
  for (std::size_t i = 0; i < 3; ++i) {
    normal_a[i] = a.normal[i][k];
    normal_b[i] = b.normal[i][k_b];
    for (std::size_t c = 0; c < 6; ++c)
      p[c][i] = a.corner[c][i][k] + static_cast<float>(shift[static_cast<Eigen::Index>(i)]);
    for (std::size_t c = 0; c < 3; ++c) q[c][i] = b.corner[c][i][k_b];
  }
  alignas(64) Across left, right;
  std::size_t count = 0;
  const auto add = [&](const Float3& x, const Float3& y) {
    for (std::size_t i = 0; i < 3; ++i) {
      left[i][count] = x[i];
      right[i][count] = y[i];
    }
    ++count;
  };
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) add(difference(p[(i + 1) % 3], p[i]), difference(q[(j + 1) % 3], q[j]));
  for (std::size_t i = 0; i < 3; ++i) {
    add(normal_a, difference(p[(i + 1) % 3], p[i]));
    add(normal_b, difference(q[(i + 1) % 3], q[i]));
  }
  add(normal_a, normal_b);
  const float least = floor_in_single(a.size, b, shift, floor);
  const std::uint32_t one = across_edges(left, right, p, q, least * least);
  if (one == kAcross) return false;
  direction = across({left[0][one], left[1][one], left[2][one]}, {right[0][one], right[1][one], right[2][one]});
  return true;
}

}  // namespace tegotae
