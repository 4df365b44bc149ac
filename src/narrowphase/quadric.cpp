#include "narrowphase/quadric.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/numbers.hpp"
#include "narrowphase/face_gaps.hpp"

namespace tegotae {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

/// Corners that a quadric is fitted to, about, and what is added to the squares of all directions, where they tell
/// nothing of some.
constexpr std::size_t kFitted = 96;
constexpr double kDamping = 1e-9;
/// One that leaves more of the slab's thickness than this is none; nor is one that is steeper anywhere over the slab.
constexpr double kFits = 0.25, kSteepest = 1;
/// Slabs that are thinner than this share of their length are flat.
constexpr double kFlat = 1e-4;
/// Rounding in single precision, as a share of the heights themselves, and of all coordinates that they come from: some
/// dozens of operations, of 6e-8 each.
constexpr double kQuadricError = 1e-6;
constexpr float kHeightError = 1e-5F;
/// Of what is steep where it is far from a slab's center, as a share of it.
constexpr float kSteepError = 2e-6F;
/// Of the cosine between two slabs: where they are steeper to each other, one is not seen as a height over the other.
constexpr float kFacing = 0.5F;

/// A corner of a face over the first two axes of a slab, and its height.
struct Point {
  Vector2d at;
  double height;
};

/// The height at a point, as the symmetric form that is linear in both places of it (the blossom).
double height(const Quadric& q, const Vector2d& x, const Vector2d& y) {
  return q.height + 0.5 * q.slope.dot(x + y) + 0.5 * x.dot(q.bend * y);
}

/// By least squares.
Quadric fitted(const std::vector<Point>& points, const Vector2d& half) {
  typedef Eigen::Matrix<double, 6, 1> Row;
  Eigen::Matrix<double, 6, 6> squares = Eigen::Matrix<double, 6, 6>::Zero();
  Row right = Row::Zero();
  const std::size_t stride = points.size() / kFitted + 1;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    const Vector2d x = points[i].at.cwiseQuotient(half);
    Row row;
    row << 1, x.x(), x.y(), 0.5 * x.x() * x.x(), x.x() * x.y(), 0.5 * x.y() * x.y();
    squares += row * row.transpose();
    right += points[i].height * row;
  }
  squares.diagonal().array() += kDamping * squares(0, 0);
  const Row c = squares.ldlt().solve(right);
  Matrix2d bend;
  bend << c[3], c[4], c[4], c[5];
  const auto shrunk = half.cwiseInverse().asDiagonal();
  return {c[0], shrunk * c.segment<2>(1), shrunk * bend * shrunk, 0};
}

struct Range {
  double low = kInfinity, high = -kInfinity;

  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

/// To `range`: the heights of a face over a quadric. They are within the coefficients of Bernstein's form on each
/// quarter of the face.
void add_heights(const Quadric& q, const Point* corners, Range& range) {
  double at[3], along[3];  // the coefficients of the corners, and those of the edges across from them
  for (std::size_t i = 0; i < 3; ++i) {
    const Point &j = corners[(i + 1) % 3], &k = corners[(i + 2) % 3];
    at[i] = corners[i].height - height(q, corners[i].at, corners[i].at);
    along[i] = 0.5 * (j.height + k.height) - height(q, j.at, k.at);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    range.add(at[i]);
    range.add(0.5 * (at[i] + along[j]));
    range.add(0.5 * (at[i] + along[k]));
    range.add(0.25 * (at[j] + at[k]) + 0.5 * along[i]);
    range.add(0.25 * (at[i] + along[0] + along[1] + along[2]));
  }
}

/// Puts it in the middle of all heights of faces over it.
void center(Quadric& q, const std::vector<Point>& corners) {
  Range range;
  for (std::size_t i = 0; i < corners.size(); i += 3) add_heights(q, &corners[i], range);
  q.height += 0.5 * (range.low + range.high);
  q.off = 0.5 * (range.high - range.low);
}

struct Lanes2 {
  Lane x, y;
};

/// The axes of eight slabs, of unit length.
struct LaneAxes {
  Lanes3 u, v, n;
};

TEGOTAE_INLINE Lanes3 scaled(const std::array<SlabLanes::Field, 3>& axis, Lane factor) {
  const Lanes3 x = all_of(axis);
  return {x.x * factor, x.y * factor, x.z * factor};
}

TEGOTAE_INLINE Lanes3 seen(const LaneAxes& axes, const Float3& x) {
  return {dot(axes.u, x), dot(axes.v, x), dot(axes.n, x)};
}

TEGOTAE_INLINE Lane dot(const Lanes3& a, const Lanes3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

TEGOTAE_INLINE Lanes3 sum(Lane s, const Lanes3& x, Lane t, const Lanes3& y) {
  return {s * x.x + t * y.x, s * x.y + t * y.y, s * x.z + t * y.z};
}

TEGOTAE_INLINE Lanes3 plus(const Lanes3& x, const Lanes3& y) {
  return {x.x + y.x, x.y + y.y, x.z + y.z};
}

/// What A's slab is at one end, as eight others see it from their centers: its axes `u` and `v` as long as its halves.
struct SeenEnd {
  Lanes3 center, u, v, n;
};

/// Symmetric.
struct LaneBend {
  Lane xx, xy, yy;

  TEGOTAE_INLINE Lanes2 times(Lane x, Lane y) const { return {xx * x + xy * y, xy * x + yy * y}; }
  TEGOTAE_INLINE Lane between(const Lanes2& a, const Lanes2& b) const {
    return a.x * (xx * b.x + xy * b.y) + a.y * (xy * b.x + yy * b.y);
  }
};

struct LaneQuadric {
  Lane height, off;
  Lanes2 slope;
  LaneBend bend;
};

struct LaneRange {
  Lane low, high;
};

/// What of A's slab comes to where another one is, along one of that one's axes from its center: `at` A's center,
/// `size` as far as A's slab is from it.
TEGOTAE_INLINE LaneRange part_over(Lane at, Lane size, Lane reach) {
  return {greater(-size, -reach - at), lesser(size, reach - at)};
}

/// The heights of A's faces over the eight quadrics `of_b` at one end, in the part of A's slab about `end.center` that
/// is `size` large along `end.u` and `end.v`, where they follow `of_a` and are no farther than `thickness` along
/// `end.n`.
TEGOTAE_INLINE LaneRange heights(const SeenEnd& end, const Lanes2& size, const LaneQuadric& of_a, float thickness,
                                 const LaneQuadric& of_b) {
  const Lanes3 &at = end.center, &u = end.u, &v = end.v, &n = end.n;
  const Lanes2 bent_at = of_b.bend.times(at.x, at.y), bent_u = of_b.bend.times(u.x, u.y),
               bent_v = of_b.bend.times(v.x, v.y), bent_n = of_b.bend.times(n.x, n.y);
  const Lane slope_x = of_b.slope.x + bent_at.x, slope_y = of_b.slope.y + bent_at.y;
  // What is w along `n` is higher by `rises` w at the center, and by some more elsewhere and for a large w.
  const Lane rises = n.z - slope_x * n.x - slope_y * n.y;
  const Lane more = thickness * (size.x * size_of(u.x * bent_n.x + u.y * bent_n.y) +
                                 size.y * size_of(v.x * bent_n.x + v.y * bent_n.y)) +
                    0.5F * thickness * thickness * size_of(n.x * bent_n.x + n.y * bent_n.y);
  const Lane middle = at.z - of_b.height - 0.5F * (at.x * (of_b.slope.x + slope_x) + at.y * (of_b.slope.y + slope_y)) +
                      rises * of_a.height;
  const Lane by_u = u.z - slope_x * u.x - slope_y * u.y + rises * of_a.slope.x,
             by_v = v.z - slope_x * v.x - slope_y * v.y + rises * of_a.slope.y;
  const Lane uu = rises * of_a.bend.xx - (u.x * bent_u.x + u.y * bent_u.y),
             vv = rises * of_a.bend.yy - (v.x * bent_v.x + v.y * bent_v.y),
             uv = rises * of_a.bend.xy - (u.x * bent_v.x + u.y * bent_v.y);
  const Lane any = size.x * size_of(by_u) + size.y * size_of(by_v) + size.x * size.y * size_of(uv) +
                   size_of(rises) * of_a.off + more +
                   kSteepError * ((size_of(at.x) + size.x) * (size_of(of_b.slope.x) + size_of(slope_x)) +
                                  (size_of(at.y) + size.y) * (size_of(of_b.slope.y) + size_of(slope_y)));
  const Lane half_u2 = 0.5F * size.x * size.x, half_v2 = 0.5F * size.y * size.y;
  return {middle - any + half_u2 * lesser(uu, Lane{}) + half_v2 * lesser(vv, Lane{}),
          middle + any + half_u2 * greater(uu, Lane{}) + half_v2 * greater(vv, Lane{})};
}

/// The second derivative of the height of A's points along their way.
TEGOTAE_INLINE LaneRange bends(const SeenEnd& from, const SeenEnd& to, const Lanes2& size, float thickness,
                               const LaneBend& bend) {
  const Lane x = to.center.x - from.center.x, y = to.center.y - from.center.y;
  const Lane more_x = size.x * size_of(to.u.x - from.u.x) + size.y * size_of(to.v.x - from.v.x) +
                      thickness * size_of(to.n.x - from.n.x),
             more_y = size.x * size_of(to.u.y - from.u.y) + size.y * size_of(to.v.y - from.v.y) +
                      thickness * size_of(to.n.y - from.n.y);
  const Lanes2 bent = bend.times(x, y);
  const Lane middle = x * bent.x + y * bent.y;
  const Lane beside = 2 * (size_of(bent.x) * more_x + size_of(bent.y) * more_y) + size_of(bend.xx) * more_x * more_x +
                      2 * size_of(bend.xy) * more_x * more_y + size_of(bend.yy) * more_y * more_y;
  return {middle - beside, middle + beside};
}

/// Of gaps of so much at the start and the end of a motion, whose arcs take 4 `bulge` s (1 − s) off: those that stay
/// positive, and about how long the others do.
struct GapLanes {
  LaneBits positive;
  Lane share;
};

TEGOTAE_INLINE GapLanes gaps_that_stay(Lane start, Lane end, Lane bulge) {
  const Lane lacks = 2 * bulge - 0.5F * (start + end);
  const LaneBits positive =
      (LaneBits)(start >= 0) & (LaneBits)(end >= 0) &
      ((LaneBits)(lesser(start, end) >= bulge) | (LaneBits)(lacks <= 0) | (LaneBits)(start * end >= lacks * lacks));
  const Lane used = start - end + 5 * bulge;
  const Lane share = start > 0 ? start / greater(used, start) : Lane{};
  return {positive, share};
}

TEGOTAE_WIDE std::uint32_t apart_by_heights(const SlabEnds& a, const QuadricLanes& of_a, std::uint32_t k,
                                            const Float3& shift, const SlabLanes& b, const QuadricLanes& of_b,
                                            float floor, QuadricLanes::Field& share_of) {
  const float error = kHeightError * (a.size + b.size + sum_of_sizes(shift));
  const Lane half_u = all_of(of_b.half[0]), half_v = all_of(of_b.half[1]);
  const LaneAxes axes = {scaled(b.sides[0], 1.0F / half_u), scaled(b.sides[1], 1.0F / half_v), all_of(b.normal)};
  const Lanes3 middle_b = all_of(b.center);
  const float thickness = of_a.half[2][k];
  std::array<SeenEnd, 2> ends;
  for (std::size_t i = 0; i < 2; ++i) {
    const Float3 at = {a.center[i][0] + shift[0], a.center[i][1] + shift[1], a.center[i][2] + shift[2]};
    const Lanes3 from_b = {at[0] - middle_b.x, at[1] - middle_b.y, at[2] - middle_b.z};
    ends[i].center = {dot(axes.u, from_b), dot(axes.v, from_b), dot(axes.n, from_b)};
    ends[i].u = seen(axes, a.sides[i][0]);
    ends[i].v = seen(axes, a.sides[i][1]);
    const float unit = 1 / thickness;
    ends[i].n = seen(axes, {unit * a.sides[i][2][0], unit * a.sides[i][2][1], unit * a.sides[i][2][2]});
  }
  SeenEnd &from = ends[0], &to = ends[1];
  // What of A's slab comes as near as `floor` to where B's are over their first two axes, in the middle of the motion,
  // and what moves on both sides of that.
  const Lane ux = 0.5F * (from.u.x + to.u.x), uy = 0.5F * (from.u.y + to.u.y), vx = 0.5F * (from.v.x + to.v.x),
             vy = 0.5F * (from.v.y + to.v.y);
  const Lane moves_x = size_of(to.center.x - from.center.x) + size_of(to.u.x - from.u.x) + size_of(to.v.x - from.v.x),
             moves_y = size_of(to.center.y - from.center.y) + size_of(to.u.y - from.u.y) + size_of(to.v.y - from.v.y);
  const float slack = floor + error;
  const LaneRange x =
      part_over(0.5F * (from.center.x + to.center.x), size_of(ux) + size_of(vx),
                half_u + slack + 0.5F * moves_x + thickness * greater(size_of(from.n.x), size_of(to.n.x)));
  const LaneRange y =
      part_over(0.5F * (from.center.y + to.center.y), size_of(uy) + size_of(vy),
                half_v + slack + 0.5F * moves_y + thickness * greater(size_of(from.n.y), size_of(to.n.y)));
  const LaneBits beside = (LaneBits)(x.high < x.low) | (LaneBits)(y.high < y.low);
  // Along B's axes from here on: A's own are these combinations of theirs.
  const Lane area = ux * vy - uy * vx;
  const LaneBits faces = (LaneBits)(size_of(area) >= kFacing * of_a.half[0][k] * of_a.half[1][k]);
  const Lane scale = 1.0F / area;
  const Lane u_by_x = vy * scale, v_by_x = -uy * scale, u_by_y = -vx * scale, v_by_y = ux * scale;
  const Lane at_x = 0.5F * (x.low + x.high), at_y = 0.5F * (y.low + y.high);
  const Lanes2 size = {0.5F * (x.high - x.low), 0.5F * (y.high - y.low)};
  for (SeenEnd& end : ends) {
    const Lanes3 along_x = sum(u_by_x, end.u, v_by_x, end.v), along_y = sum(u_by_y, end.u, v_by_y, end.v);
    end.center = plus(end.center, sum(at_x, along_x, at_y, along_y));
    end.u = along_x;
    end.v = along_y;
  }
  const float su = of_a.half[0][k] * of_a.slope[0][k], sv = of_a.half[1][k] * of_a.slope[1][k];
  const float buu = of_a.half[0][k] * of_a.half[0][k] * of_a.bend[0][k],
              buv = of_a.half[0][k] * of_a.half[1][k] * of_a.bend[1][k],
              bvv = of_a.half[1][k] * of_a.half[1][k] * of_a.bend[2][k];
  const LaneBend own = {Lane{} + buu, Lane{} + buv, Lane{} + bvv};
  const Lanes2 by_x = {u_by_x, v_by_x}, by_y = {u_by_y, v_by_y};
  LaneQuadric seen_a;
  seen_a.bend = {own.between(by_x, by_x), own.between(by_x, by_y), own.between(by_y, by_y)};
  seen_a.slope = {su * u_by_x + sv * v_by_x, su * u_by_y + sv * v_by_y};
  const Lanes2 bent = seen_a.bend.times(at_x, at_y);
  seen_a.height = of_a.height[k] + at_x * (seen_a.slope.x + 0.5F * bent.x) + at_y * (seen_a.slope.y + 0.5F * bent.y);
  seen_a.slope.x += bent.x;
  seen_a.slope.y += bent.y;
  seen_a.off = Lane{} + of_a.off[k];
  const LaneQuadric seen_b = {all_of(of_b.height),
                              all_of(of_b.off),
                              {all_of(of_b.slope[0]), all_of(of_b.slope[1])},
                              {all_of(of_b.bend[0]), all_of(of_b.bend[1]), all_of(of_b.bend[2])}};
  const LaneRange start = heights(from, size, seen_a, thickness, seen_b),
                  end = heights(to, size, seen_a, thickness, seen_b);
  // What is `floor` away from something over B's slab is so much higher: heights grow by no more than this.
  const Lane steep_x = size_of(seen_b.slope.x) + size_of(seen_b.bend.xx) * (half_u + slack) +
                       size_of(seen_b.bend.xy) * (half_v + slack),
             steep_y = size_of(seen_b.slope.y) + size_of(seen_b.bend.xy) * (half_u + slack) +
                       size_of(seen_b.bend.yy) * (half_v + slack);
  const Lane least = seen_b.off + error + floor * (1 + 0.5F * (steep_x * steep_x + steep_y * steep_y));
  const LaneRange bend = bends(from, to, size, thickness, seen_b.bend);
  const GapLanes above = gaps_that_stay(start.low - least, end.low - least, 0.125F * greater(-bend.low, Lane{})),
                 below = gaps_that_stay(-start.high - least, -end.high - least, 0.125F * greater(bend.high, Lane{}));
  const Lane share = faces ? greater(above.share, below.share) : Lane{};
  std::memcpy(share_of.data(), &share, sizeof share);  // it may lie anywhere
  return together((beside | (faces & (above.positive | below.positive))) & kEachBit);
}

}  // namespace

std::optional<Quadric> quadric_of(const std::vector<Vec3>& corners, const Slab& slab) {
  std::vector<Point> points;
  points.reserve(corners.size());
  for (const Vec3& corner : corners) {
    const Vec3 p = slab.axes.transpose() * (corner - slab.center);
    points.push_back({p.head<2>(), p.z()});
  }
  const Vector2d half = slab.half.head<2>();
  Quadric q = fitted(points, half);
  center(q, points);
  const Vector2d bent = q.bend.cwiseAbs() * half, steep = q.slope.cwiseAbs() + bent;
  q.off += kQuadricError * (std::abs(q.height) + steep.dot(half));
  const bool curved = slab.half.z() > kFlat * half.maxCoeff();
  const bool fits = curved && q.off >= 0 && q.off < kFits * slab.half.z() && steep.maxCoeff() < kSteepest;
  return fits ? std::optional<Quadric>(q) : std::nullopt;
}

QuadricLanes::QuadricLanes(const Slab* slabs, const std::optional<Quadric>* quadrics, std::size_t count) {
  for (std::size_t k = 0; k < FaceBlocks::kFan; ++k) {
    const std::size_t i = std::min(k, count - 1);
    const Quadric q = quadrics[i].value_or(Quadric{0, Vector2d::Zero(), Matrix2d::Zero(), slabs[i].half.z()});
    if (quadrics[i]) fits |= 1U << k;
    for (std::size_t axis = 0; axis < 3; ++axis)
      half[axis][k] = static_cast<float>(slabs[i].half[static_cast<Eigen::Index>(axis)]);
    height[k] = static_cast<float>(q.height);
    off[k] = static_cast<float>(q.off * (1 + kQuadricError));
    slope[0][k] = static_cast<float>(q.slope.x());
    slope[1][k] = static_cast<float>(q.slope.y());
    bend[0][k] = static_cast<float>(q.bend(0, 0));
    bend[1][k] = static_cast<float>(q.bend(0, 1));
    bend[2][k] = static_cast<float>(q.bend(1, 1));
  }
}

std::uint32_t kept_apart_by_heights(const SlabEnds& a, const QuadricLanes& of_a, std::uint32_t k, const Vec3& origin,
                                    const SlabLanes& b, const QuadricLanes& of_b, double floor,
                                    QuadricLanes::Field& share) noexcept {
  return apart_by_heights(a, of_a, k, in_single(origin - b.origin), b, of_b, static_cast<float>(floor), share);
}

}  // namespace tegotae
