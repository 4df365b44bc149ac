#include "narrowphase/near_hulls.hpp"

#include <cmath>
#include <limits>

#include "core/numbers.hpp"
#include "narrowphase/wide.hpp"

namespace tegotae {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
/// Faces thinner than this part of their longest edge have no plane.
constexpr double kParallel = 1e-6;
/// Crosses of edges shorter than this (m²) are too near to the least number of single precision.
constexpr float kLeastCross2 = 1e-30F;
/// Distances are right up to this share of themselves: normals and axes are of unit length, and at right angles, up to
/// single precision. Positions and extents, from the frame's origin, are right up to this share of their sum: a dozen
/// roundings of 6e-8, and 1e-6 of the way, whose direction is no better than the axes.
constexpr float kAxisSlack = 1 - 1e-5F, kSizeSlack = 8e-6F;

/// Conditions on vectors longer than a register would go number by number.
constexpr int kLane = 8, kFineLane = 4;
typedef float Lane __attribute__((vector_size(kLane * sizeof(float)), may_alias));
typedef std::int32_t LaneBits __attribute__((vector_size(kLane * sizeof(float)), may_alias));
typedef double FineLane __attribute__((vector_size(kFineLane * sizeof(double)), may_alias));
typedef std::int64_t FineBits __attribute__((vector_size(kFineLane * sizeof(double)), may_alias));
static_assert(kMeasured == kLane);

struct Lanes3 {
  Lane x, y, z;
};
struct Fine3 {
  FineLane x, y, z;
};

TEGOTAE_INLINE Lane load(const NearHulls::Field& field) {
  return *reinterpret_cast<const Lane*>(field.data());
}
TEGOTAE_INLINE void store(Lane x, Nearness::Field& field) {
  *reinterpret_cast<Lane*>(field.data()) = x;
}
TEGOTAE_INLINE Lanes3 load3(const std::array<NearHulls::Field, 3>& f) {
  return {load(f[0]), load(f[1]), load(f[2])};
}
TEGOTAE_INLINE FineLane load_fine(const KnownPlanes::Field& field, int first) {
  return *reinterpret_cast<const FineLane*>(field.data() + first);
}
TEGOTAE_INLINE Lane magnitude(Lane x) {
  return (Lane)((LaneBits)x & 0x7fffffff);
}
TEGOTAE_INLINE FineLane magnitude(FineLane x) {
  return (FineLane)((FineBits)x & 0x7fffffffffffffff);
}
template <typename Number>
TEGOTAE_INLINE Number lesser(Number a, Number b) {
  return a < b ? a : b;
}
template <typename Number>
TEGOTAE_INLINE Number greater(Number a, Number b) {
  return a > b ? a : b;
}
TEGOTAE_INLINE Lane least(Lane a, Lane b, Lane c) {
  return lesser(lesser(a, b), c);
}
TEGOTAE_INLINE Lane most(Lane a, Lane b, Lane c) {
  return greater(greater(a, b), c);
}
TEGOTAE_INLINE FineLane dot(const Fine3& a, const Vec3& b) {
  return a.x * b.x() + a.y * b.y() + a.z * b.z();
}
TEGOTAE_INLINE Lane dot(const Lanes3& a, const std::array<float, 3>& b) {
  return a.x * b[0] + a.y * b[1] + a.z * b[2];
}
TEGOTAE_INLINE Lane dot(const Lanes3& a, const Lanes3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
TEGOTAE_INLINE Lane sum(const Lanes3& a) {
  return magnitude(a.x) + magnitude(a.y) + magnitude(a.z);
}
/// Components along the axes of the frame.
TEGOTAE_INLINE Lanes3 turned(const Lanes3& v, const HullFrame& a) {
  return {dot(v, a.row[0]), dot(v, a.row[1]), dot(v, a.row[2])};
}
/// 1 / sqrt(x) up to single precision, and some finite number for 0: vectors have no root of their own.
TEGOTAE_INLINE Lane reciprocal_root(Lane x) {
  Lane y = (Lane)(0x5f3759df - ((LaneBits)x >> 1));
  for (int i = 0; i < 3; ++i) y = y * (1.5F - (0.5F * x * y) * y);
  return y;
}

/// The best normal so far; see Nearness::Side.
struct Best {
  Lane gap = Lane{} - kFar, normal = Lane{};

  TEGOTAE_INLINE void offer(Lane up, Lane down, float number) {
    const Lane more = greater(up, down), one = Lane{} + number, sign = up > down ? one : -one;
    normal = more > gap ? sign : normal;
    gap = greater(more, gap);
  }
};

/// Gaps along the frame's axes to what reaches from `low` to `high`, and the distance of the two upright boxes.
TEGOTAE_INLINE void offer_axis(const HullFrame& a, int i, Lane low, Lane high, Best& best, Best& upright,
                               Lane& distance2) {
  const Lane up = a.low[i] - high, down = low - a.high[i];
  const float number = static_cast<float>(1 + i);
  best.offer(up, down, number);
  if (i == 2) upright.offer(up, down, number);
  const Lane apart = greater(greater(up, down), Lane{});
  distance2 += apart * apart;
}

/// Extent of the piece of A along directions in its frame.
TEGOTAE_INLINE void extent(const HullFrame& a, const Lanes3& n, Lane& low, Lane& high) {
  const Lane way = magnitude(dot(n, a.way));
  if (a.triangle) {
    const Lane p = dot(n, a.corner[0]), q = dot(n, a.corner[1]), r = dot(n, a.corner[2]);
    low = least(p, q, r) - way;
    high = most(p, q, r) + way;
    return;
  }
  high = a.half[0] * magnitude(n.x) + a.half[1] * magnitude(n.y) + a.half[2] * magnitude(n.z) + way;
  low = -high;
}

/// `size`: of the positions and extents of B's pieces.
TEGOTAE_INLINE void store_result(const HullFrame& a, const Best& best, const Best& upright, Lane distance2, Lane size,
                                 Nearness& out) {
  store(best.gap, out.any.gap);
  store(best.normal, out.any.normal);
  store(upright.gap, out.upright.gap);
  store(upright.normal, out.upright.normal);
  const Lane apart = greater(best.gap, distance2 * reciprocal_root(distance2));
  store(kAxisSlack * apart - kSizeSlack * (size + a.size), out.distance);
}

}  // namespace

HullFrame::HullFrame(const Hull& a, const Vec3& ahead) : origin(a.middle() + 0.5 * ahead), triangle(a.is_triangle()) {
  std::array<double, 3> from, to, shift;
  if (!triangle) {
    for (int i = 0; i < 3; ++i) {
      axis[i] = a.axis(i);
      shift[i] = 0.5 * axis[i].dot(ahead);
      half[i] = static_cast<float>(a.half(i));
      to[i] = a.half(i);
      from[i] = -to[i];
    }
  } else {
    const Vec3 middle = a.middle();
    Vec3 longest = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      const Vec3 e = a.corner((k + 1) % 3) - a.corner(k);
      if (e.squaredNorm() > longest.squaredNorm()) longest = e;
    }
    const double length = longest.norm();
    axis[0] = length > 0 ? Vec3(longest / length) : Vec3(Vec3::UnitX());
    axis[2] = (a.corner(1) - a.corner(0)).cross(a.corner(2) - a.corner(0));
    if (!(axis[2].norm() > kParallel * length * length))
      axis[2] = axis[0].cross(std::abs(axis[0].x()) < 0.7 ? Vec3::UnitX() : Vec3::UnitY());
    axis[1] = axis[2].cross(axis[0]).normalized();
    axis[2] = axis[0].cross(axis[1]);
    from.fill(kInfinity);
    to.fill(-kInfinity);
    for (int i = 0; i < 3; ++i) {
      shift[i] = 0.5 * axis[i].dot(ahead);
      for (int k = 0; k < 3; ++k) {
        const double at = axis[i].dot(a.corner(k) - middle);
        corner[k][i] = static_cast<float>(at);
        from[i] = std::min(from[i], at);
        to[i] = std::max(to[i], at);
      }
    }
  }
  double all = 0;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) row[i][k] = static_cast<float>(axis[i][k]);
    coarse[i] = static_cast<float>(origin[i]);
    fine[i] = static_cast<float>(origin[i] - double{coarse[i]});
    way[i] = static_cast<float>(shift[i]);
    low[i] = static_cast<float>(from[i] - std::abs(shift[i]));
    high[i] = static_cast<float>(to[i] + std::abs(shift[i]));
    all += std::max(to[i], -from[i]) + std::abs(shift[i]);
  }
  size = static_cast<float>(all);
}

TEGOTAE_WIDE void measure_boxes(const HullFrame& a, const NearHulls& b, Nearness& out) noexcept {
  const Lanes3 at = load3(b.center), half = load3(b.half);
  const Lanes3 center{(at.x - a.coarse[0]) - a.fine[0], (at.y - a.coarse[1]) - a.fine[1],
                      (at.z - a.coarse[2]) - a.fine[2]};
  const Lanes3 d = turned(center, a);
  const Lanes3 own[3] = {load3(b.edge[0]), load3(b.edge[1]), load3(b.edge[2])};
  const Lanes3 m[3] = {turned(own[0], a), turned(own[1], a), turned(own[2], a)};
  const Lane x = half.x * magnitude(m[0].x) + half.y * magnitude(m[1].x) + half.z * magnitude(m[2].x);
  const Lane y = half.x * magnitude(m[0].y) + half.y * magnitude(m[1].y) + half.z * magnitude(m[2].y);
  const Lane z = half.x * magnitude(m[0].z) + half.y * magnitude(m[1].z) + half.z * magnitude(m[2].z);
  Best best, upright;
  Lane distance2{};
  offer_axis(a, 0, d.x - x, d.x + x, best, upright, distance2);
  offer_axis(a, 1, d.y - y, d.y + y, best, upright, distance2);
  offer_axis(a, 2, d.z - z, d.z + z, best, upright, distance2);
  const Lane width[3] = {half.x, half.y, half.z};
  for (int j = 0; j < 3; ++j) {
    Lane low, high;
    extent(a, m[j], low, high);
    const Lane level = dot(center, own[j]);
    const Lane up = low - (level + width[j]), down = level - width[j] - high;
    best.offer(up, down, static_cast<float>(4 + j));
    if (j == 2) upright.offer(up, down, 6);
  }
  store_result(a, best, upright, distance2, sum(center) + sum(half), out);
}

TEGOTAE_WIDE void measure_triangles(const HullFrame& a, const NearHulls& b, Nearness& out) noexcept {
  const Lanes3 corner[3] = {load3(b.edge[0]), load3(b.edge[1]), load3(b.edge[2])};
  const Lanes3 p[3] = {turned(corner[0], a), turned(corner[1], a), turned(corner[2], a)};
  Best best, upright;
  Lane distance2{};
  offer_axis(a, 0, least(p[0].x, p[1].x, p[2].x), most(p[0].x, p[1].x, p[2].x), best, upright, distance2);
  offer_axis(a, 1, least(p[0].y, p[1].y, p[2].y), most(p[0].y, p[1].y, p[2].y), best, upright, distance2);
  offer_axis(a, 2, least(p[0].z, p[1].z, p[2].z), most(p[0].z, p[1].z, p[2].z), best, upright, distance2);
  // The plane of the triangle, along the axes of the frame.
  const Lanes3 e{p[1].x - p[0].x, p[1].y - p[0].y, p[1].z - p[0].z};
  const Lanes3 f{p[2].x - p[0].x, p[2].y - p[0].y, p[2].z - p[0].z};
  Lanes3 n{e.y * f.z - e.z * f.y, e.z * f.x - e.x * f.z, e.x * f.y - e.y * f.x};
  const Lane length2 = dot(n, n), size2 = dot(e, e) + dot(f, f), scale = reciprocal_root(length2);
  n.x *= scale;
  n.y *= scale;
  n.z *= scale;
  Lane low, high;
  extent(a, n, low, high);
  // Rounding of the normal of a thin triangle has its corners at different heights.
  const Lane h0 = dot(n, p[0]), h1 = dot(n, p[1]), h2 = dot(n, p[2]);
  const Lane none = Lane{} - kFar, least_cross = Lane{} + kLeastCross2;
  const Lane least_length2 = static_cast<float>(kParallel * kParallel) * size2 * size2;
  const LaneBits flat = length2 > greater(least_length2, least_cross);
  const Lane up = flat ? low - most(h0, h1, h2) : none, down = flat ? least(h0, h1, h2) - high : none;
  best.offer(up, down, 4);
  upright.offer(up, down, 4);
  store_result(a, best, upright, distance2, most(sum(corner[0]), sum(corner[1]), sum(corner[2])), out);
}

void KnownPlanes::clear() {
  for (Field& f : n) f.fill(0);
  low_start.fill(-kInfinity);
  low_end.fill(-kInfinity);
  top.fill(0);
}

TEGOTAE_WIDE int first_above(const KnownPlanes& planes, int count, const Hull& b, double gap_start, double gap_end,
                             std::array<double, kCellPlanes>& tops) noexcept {
  static_assert(kCellPlanes % kFineLane == 0);
  for (int first = 0; first < count; first += kFineLane) {
    const Fine3 n{load_fine(planes.n[0], first), load_fine(planes.n[1], first), load_fine(planes.n[2], first)};
    FineLane top;
    if (b.is_triangle()) {
      top = greater(greater(dot(n, b.corner(0)), dot(n, b.corner(1))), dot(n, b.corner(2)));
    } else {
      top = dot(n, b.middle()) + b.half(0) * magnitude(dot(n, b.axis(0))) + b.half(1) * magnitude(dot(n, b.axis(1))) +
            b.half(2) * magnitude(dot(n, b.axis(2)));
    }
    __builtin_memcpy(tops.data() + first, &top, sizeof(top));
    const FineLane start = load_fine(planes.low_start, first) - top, end = load_fine(planes.low_end, first) - top;
    const FineBits above = (start >= gap_start) & (end >= gap_end);
    for (int k = 0; k < kFineLane; ++k)
      if (above[k] != 0) return first + k;
  }
  return kCellPlanes;
}

}  // namespace tegotae
