#include "narrowphase/near_hulls.hpp"

#include <cmath>
#include <limits>

#include "narrowphase/wide.hpp"

namespace tegotae {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Faces thinner than this part of their longest edge have no plane.
constexpr double kParallel = 1e-6;

/// Conditions on vectors longer than a register would go number by number.
constexpr int kLane = 4;
typedef double Lane __attribute__((vector_size(kLane * sizeof(double)), may_alias));
typedef std::int64_t LaneBits __attribute__((vector_size(kLane * sizeof(double)), may_alias));

struct Lanes3 {
  Lane x, y, z;
};

/// Four numbers of a field, from `first` on.
template <typename Field>
TEGOTAE_INLINE Lane load(const Field& field, int first) {
  return *reinterpret_cast<const Lane*>(field.data() + first);
}
template <typename Field>
TEGOTAE_INLINE void store(Lane x, Field& field, int first) {
  *reinterpret_cast<Lane*>(field.data() + first) = x;
}
template <typename Field>
TEGOTAE_INLINE Lanes3 load3(const std::array<Field, 3>& f, int first) {
  return {load(f[0], first), load(f[1], first), load(f[2], first)};
}
TEGOTAE_INLINE Lane magnitude(Lane x) {
  return (Lane)((LaneBits)x & 0x7fffffffffffffff);
}
TEGOTAE_INLINE Lane lesser(Lane a, Lane b) {
  return a < b ? a : b;
}
TEGOTAE_INLINE Lane greater(Lane a, Lane b) {
  return a > b ? a : b;
}
TEGOTAE_INLINE Lane dot(const Lanes3& a, const Vec3& b) {
  return a.x * b.x() + a.y * b.y() + a.z * b.z();
}
TEGOTAE_INLINE Lane dot(const Lanes3& a, const std::array<double, 3>& b) {
  return a.x * b[0] + a.y * b[1] + a.z * b[2];
}
/// Components along the axes of the frame.
TEGOTAE_INLINE Lanes3 turned(const Lanes3& v, const HullFrame& a) {
  return {dot(v, a.axis[0]), dot(v, a.axis[1]), dot(v, a.axis[2])};
}

/// The best normal so far; `n` along the axes of the frame, or of B.
struct Best {
  Lane gap = Lane{} - kInfinity, side = Lane{}, number = Lane{};

  TEGOTAE_INLINE void offer(Lane up, Lane down, double k) {
    const Lane more = greater(up, down), one = Lane{} + 1, sign = up > down ? one : -one, k_lane = Lane{} + k;
    side = more > gap ? sign : side;
    number = more > gap ? k_lane : number;
    gap = greater(more, gap);
  }
};

/// Gaps along the frame's axes to what reaches from `low` to `high`, and the distance of the two upright boxes.
TEGOTAE_INLINE void offer_axis(const HullFrame& a, int i, Lane low, Lane high, Best& best, Best& upright,
                               Lane& distance2) {
  const Lane up = a.low[i] - high, down = low - a.high[i];
  best.offer(up, down, i);
  if (i == 2) upright.offer(up, down, i);
  const Lane apart = greater(greater(up, down), Lane{});
  distance2 += apart * apart;
}

/// Extent of the piece of A along directions in its frame.
TEGOTAE_INLINE void extent(const HullFrame& a, const Lanes3& n, Lane& low, Lane& high) {
  const Lane way = magnitude(dot(n, a.way));
  if (a.triangle) {
    const Lane p = dot(n, a.corner[0]), q = dot(n, a.corner[1]), r = dot(n, a.corner[2]);
    low = lesser(lesser(p, q), r) - way;
    high = greater(greater(p, q), r) + way;
    return;
  }
  high = a.half[0] * magnitude(n.x) + a.half[1] * magnitude(n.y) + a.half[2] * magnitude(n.z) + way;
  low = -high;
}

TEGOTAE_INLINE void tell(const Best& best, const Best& upright, Lane distance2, int first, Nearness& out) {
  store(best.gap, out.any.gap, first);
  store(best.number, out.any.number, first);
  store(best.side, out.any.sign, first);
  store(upright.gap, out.upright.gap, first);
  store(upright.number, out.upright.number, first);
  store(upright.side, out.upright.sign, first);
  const Lane apart = greater(best.gap, Lane{});
  store(greater(distance2, apart * apart), out.distance2, first);
}

TEGOTAE_INLINE void measure_four_boxes(const HullFrame& a, const NearHulls& b, int first, Nearness& out) {
  const Lanes3 center = load3(b.center, first), d = turned(center, a);
  Best best, upright;
  Lane distance2{};
  const Lanes3 half = load3(b.half, first);
  const Lanes3 own[3] = {load3(b.edge[0], first), load3(b.edge[1], first), load3(b.edge[2], first)};
  const Lanes3 m[3] = {turned(own[0], a), turned(own[1], a), turned(own[2], a)};
  const Lane x = half.x * magnitude(m[0].x) + half.y * magnitude(m[1].x) + half.z * magnitude(m[2].x);
  const Lane y = half.x * magnitude(m[0].y) + half.y * magnitude(m[1].y) + half.z * magnitude(m[2].y);
  const Lane z = half.x * magnitude(m[0].z) + half.y * magnitude(m[1].z) + half.z * magnitude(m[2].z);
  offer_axis(a, 0, d.x - x, d.x + x, best, upright, distance2);
  offer_axis(a, 1, d.y - y, d.y + y, best, upright, distance2);
  offer_axis(a, 2, d.z - z, d.z + z, best, upright, distance2);
  for (int j = 0; j < 3; ++j) {
    Lane low, high;
    extent(a, m[j], low, high);
    const Lane level = center.x * own[j].x + center.y * own[j].y + center.z * own[j].z;
    const Lane width = j == 0 ? half.x : j == 1 ? half.y : half.z;
    const Lane up = low - (level + width), down = level - width - high;
    best.offer(up, down, 3 + j);
    if (j == 2) upright.offer(up, down, 3 + j);
  }
  tell(best, upright, distance2, first, out);
}

TEGOTAE_INLINE void measure_four_triangles(const HullFrame& a, const NearHulls& b, int first, Nearness& out) {
  const Lanes3 corner[3] = {load3(b.edge[0], first), load3(b.edge[1], first), load3(b.edge[2], first)};
  const Lanes3 p[3] = {turned(corner[0], a), turned(corner[1], a), turned(corner[2], a)};
  Best best, upright;
  Lane distance2{};
  offer_axis(a, 0, lesser(lesser(p[0].x, p[1].x), p[2].x), greater(greater(p[0].x, p[1].x), p[2].x), best, upright,
             distance2);
  offer_axis(a, 1, lesser(lesser(p[0].y, p[1].y), p[2].y), greater(greater(p[0].y, p[1].y), p[2].y), best, upright,
             distance2);
  offer_axis(a, 2, lesser(lesser(p[0].z, p[1].z), p[2].z), greater(greater(p[0].z, p[1].z), p[2].z), best, upright,
             distance2);
  const Lanes3 e{corner[1].x - corner[0].x, corner[1].y - corner[0].y, corner[1].z - corner[0].z};
  const Lanes3 f{corner[2].x - corner[0].x, corner[2].y - corner[0].y, corner[2].z - corner[0].z};
  Lanes3 n{e.y * f.z - e.z * f.y, e.z * f.x - e.x * f.z, e.x * f.y - e.y * f.x};
  const Lane length2 = n.x * n.x + n.y * n.y + n.z * n.z;
  const Lane size2 = e.x * e.x + e.y * e.y + e.z * e.z + f.x * f.x + f.y * f.y + f.z * f.z;
  // Of a triangle without a plane the normal is zero, and separates nothing.
  Lane scale{}, lost{};
  for (int k = 0; k < kLane; ++k) {
    const bool flat = length2[k] > kParallel * kParallel * size2[k] * size2[k];
    scale[k] = flat ? 1 / std::sqrt(length2[k]) : 0;
    lost[k] = flat ? 0 : kInfinity;
  }
  n.x *= scale;
  n.y *= scale;
  n.z *= scale;
  Lane low, high;
  extent(a, turned(n, a), low, high);
  const Lane level = n.x * corner[0].x + n.y * corner[0].y + n.z * corner[0].z;
  best.offer(low - level - lost, level - high - lost, 3);
  upright.offer(low - level - lost, level - high - lost, 3);
  store(n.x, out.plane[0], first);
  store(n.y, out.plane[1], first);
  store(n.z, out.plane[2], first);
  tell(best, upright, distance2, first, out);
}

}  // namespace

HullFrame::HullFrame(const Hull& a, const Vec3& ahead) : origin(a.middle() + 0.5 * ahead), triangle(a.is_triangle()) {
  if (!triangle) {
    for (int i = 0; i < 3; ++i) {
      axis[i] = a.axis(i);
      half[i] = a.half(i);
      way[i] = 0.5 * axis[i].dot(ahead);
      high[i] = half[i] + std::abs(way[i]);
      low[i] = -high[i];
    }
    return;
  }
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
  low.fill(kInfinity);
  high.fill(-kInfinity);
  for (int i = 0; i < 3; ++i) {
    way[i] = 0.5 * axis[i].dot(ahead);
    for (int k = 0; k < 3; ++k) {
      corner[k][i] = axis[i].dot(a.corner(k) - middle);
      low[i] = std::min(low[i], corner[k][i]);
      high[i] = std::max(high[i], corner[k][i]);
    }
    low[i] -= std::abs(way[i]);
    high[i] += std::abs(way[i]);
  }
}

TEGOTAE_WIDE void measure_boxes(const HullFrame& a, const NearHulls& b, int count, Nearness& out) noexcept {
  for (int first = 0; first < count; first += kLane) measure_four_boxes(a, b, first, out);
}

TEGOTAE_WIDE void measure_triangles(const HullFrame& a, const NearHulls& b, int count, Nearness& out) noexcept {
  for (int first = 0; first < count; first += kLane) measure_four_triangles(a, b, first, out);
}

void KnownPlanes::clear() {
  for (Field& f : n) f.fill(0);
  low_start.fill(-kInfinity);
  low_end.fill(-kInfinity);
  top.fill(0);
}

TEGOTAE_WIDE int first_above(const KnownPlanes& planes, int count, const Hull& b, double gap_start, double gap_end,
                             std::array<double, kCellPlanes>& tops) noexcept {
  static_assert(kCellPlanes % kLane == 0);
  for (int first = 0; first < count; first += kLane) {
    const Lanes3 n = load3(planes.n, first);
    Lane top;
    if (b.is_triangle()) {
      top = greater(greater(dot(n, b.corner(0)), dot(n, b.corner(1))), dot(n, b.corner(2)));
    } else {
      top = dot(n, b.middle()) + b.half(0) * magnitude(dot(n, b.axis(0))) + b.half(1) * magnitude(dot(n, b.axis(1))) +
            b.half(2) * magnitude(dot(n, b.axis(2)));
    }
    store(top, tops, first);
    const Lane start = load(planes.low_start, first) - top, end = load(planes.low_end, first) - top;
    const LaneBits above = (start >= gap_start) & (end >= gap_end);
    for (int k = 0; k < kLane; ++k)
      if (above[k] != 0) return first + k;
  }
  return kCellPlanes;
}

}  // namespace tegotae
