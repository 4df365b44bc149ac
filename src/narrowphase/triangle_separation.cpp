#include <algorithm>
#include <cmath>
#include <limits>

#include "narrowphase/moving_plane.hpp"
#include "narrowphase/wide.hpp"

namespace tegotae {
namespace {

constexpr int kTimeHalvings = 4;
/// Products of unit vectors shorter than this have no reliable direction.
constexpr double kParallelEdges = 1e-6;

double least(const Vec3& n, const std::array<Vec3, 3>& p) {
  return std::min(std::min(n.dot(p[0]), n.dot(p[1])), n.dot(p[2]));
}
double largest(const Vec3& n, const std::array<Vec3, 3>& p) {
  return std::max(std::max(n.dot(p[0]), n.dot(p[1])), n.dot(p[2]));
}

struct Span {
  double lo, hi;

  Span(const Vec3& n, const std::array<Vec3, 3>& p) {
    const double x = n.dot(p[0]), y = n.dot(p[1]), z = n.dot(p[2]);
    lo = std::min(std::min(x, y), z);
    hi = std::max(std::max(x, y), z);
  }
};

/// Keeps the best of the directions offered to it.
class Search {
 public:
  explicit Search(const TrianglePair& pair) : pair_(pair) {}

  /// A direction of the start and its counterpart at the end.
  void offer(const MovingPlane& p) { keep(pair_.start(p.n0), pair_.end(p.n1), p); }
  void offer_both_ways(const Vec3& n0, const Vec3& n1, bool with_a) {
    const Span a0(n0, pair_.p0), b0(n0, pair_.q), a1(n1, pair_.p1), b1(n1, pair_.q);
    if (a0.lo - b0.hi > b0.lo - a0.hi || a1.lo - b1.hi > b1.lo - a1.hi)
      keep(a0.lo - b0.hi, a1.lo - b1.hi, {n0, n1, with_a});
    if (a0.lo - b0.hi <= b0.lo - a0.hi || a1.lo - b1.hi <= b1.lo - a1.hi)
      keep(b0.lo - a0.hi, b1.lo - a1.hi, {-n0, -n1, with_a});
  }

  /// The largest separation that a known direction has at both ends.
  double both() const { return both_; }
  /// Largest separation at the start and at the end.
  double start() const { return start_; }
  double end() const { return end_; }
  const MovingPlane& best() const { return best_; }

  /// Tries the direction that is best for both ends at once.
  bool accept_together(const Bulge& bulge, const Sweep& sweep, MovingPlane& plane) const {
    return accept(together_, bulge, sweep, plane);
  }
  /// Tries that, then the best of each end.
  bool accept(const Bulge& bulge, const Sweep& sweep, MovingPlane& plane) const {
    return accept_together(bulge, sweep, plane) || accept(best_, bulge, sweep, plane);
  }

 private:
  bool accept(const MovingPlane& p, const Bulge& bulge, const Sweep& sweep, MovingPlane& plane) const {
    if (start_ < 0 || end_ < 0 || !stays_apart(pair_, p.n0, p.n1, bulge, sweep, 0)) return false;
    plane = p;
    return true;
  }
  void keep(double s0, double s1, const MovingPlane& p) {
    if (s0 > start_) start_ = s0, best_.n0 = p.n0;
    if (s1 > end_) end_ = s1, best_.n1 = p.n1, best_.with_a = p.with_a;
    if (std::min(s0, s1) > both_) both_ = std::min(s0, s1), together_ = p;
  }

  const TrianglePair& pair_;
  double start_ = -std::numeric_limits<double>::infinity();
  double end_ = start_;
  double both_ = start_;
  MovingPlane best_{Vec3::Zero(), Vec3::Zero()};
  MovingPlane together_{Vec3::Zero(), Vec3::Zero()};
};

/// Closest points of the segments p + s u and q + t v, s, t in [0, 1]; returns the vector from the second to the first
/// (Ericson, "Real-Time Collision Detection", 5.1.9).
Vec3 segment_gap(const Vec3& p, const Vec3& u, const Vec3& q, const Vec3& v) {
  const Vec3 w = p - q;
  const double a = u.squaredNorm(), e = v.squaredNorm(), f = v.dot(w);
  auto clamp01 = [](double x) { return std::min(std::max(x, 0.0), 1.0); };
  double s = 0, t = 0;
  const double c = u.dot(w), b = u.dot(v);
  const double denominator = a * e - b * b;
  if (a > 0 && denominator > 0) s = clamp01((b * f - c * e) / denominator);
  if (e > 0) t = (b * s + f) / e;
  if (t < 0 || t > 1 || e <= 0) {
    t = clamp01(t);
    s = a > 0 ? clamp01((b * t - c) / a) : 0;
  }
  return w + s * u - t * v;
}

/// Direction between the closest points of the two triangles' edges, from B to A, or zero.
Vec3 edge_direction(const std::array<Vec3, 3>& p, const std::array<Vec3, 3>& q) {
  Vec3 best = Vec3::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Vec3 d = segment_gap(p[i], p[(i + 1) % 3] - p[i], q[j], q[(j + 1) % 3] - q[j]);
      const double l = d.squaredNorm();
      if (l < least) least = l, best = d;
    }
  }
  return least > 0 ? Vec3(best / std::sqrt(least)) : Vec3(Vec3::Zero());
}

/// Thinner than kParallelEdges of its longest edge.
bool degenerate(const std::array<Vec3, 3>& v) {
  const Vec3 e = v[1] - v[0], f = v[2] - v[0], g = v[2] - v[1];
  return !(e.cross(f).norm() > kParallelEdges * std::max({e.squaredNorm(), f.squaredNorm(), g.squaredNorm()}));
}

/// Not of unit length; the normal is zero where its direction would be rounding.
struct Edges {
  std::array<Vec3, 3> e;
  Vec3 n;

  explicit Edges(const std::array<Vec3, 3>& v) {
    double longest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      e[i] = v[(i + 1) % 3] - v[i];
      longest = std::max(longest, e[i].squaredNorm());
    }
    n = e[0].cross(e[1]);
    if (!(n.norm() > kParallelEdges * kParallelEdges * longest)) n.setZero();
  }
};

/// The cheap directions: both normals, and from center to center.
void offer_normals(const TrianglePair& t, Search& search) {
  auto normal = [](const std::array<Vec3, 3>& v) { return (v[1] - v[0]).cross(v[2] - v[0]).normalized(); };
  const Vec3 b = normal(t.q);
  search.offer_both_ways(b, b, false);
  search.offer_both_ways(normal(t.p0), normal(t.p1), true);
  const Vec3 center = t.q[0] + t.q[1] + t.q[2];
  search.offer(
      {(t.p0[0] + t.p0[1] + t.p0[2] - center).normalized(), (t.p1[0] + t.p1[1] + t.p1[2] - center).normalized()});
}

enum class Axes : std::uint8_t { promising, all };

/// A direction across two edges, or across a normal and an edge, at the two ends of the motion.
struct Product {
  const Vec3 *left0, *right0, *left1, *right1;
  bool with_a;
};
constexpr std::size_t kProducts = 15;
/// Gaps along products are right up to this share of the positions' size. A product of nearly parallel edges has an
/// error of 1e-16 of their lengths, and counts from kParallelEdges of them on.
constexpr double kProductSlack = 1e-9;

constexpr std::size_t kLane = 8;
typedef double Lane __attribute__((vector_size(kLane * sizeof(double)), may_alias));
struct Lanes3 {
  Lane x, y, z;
};
/// Vectors one after the other; as many as fill the lanes.
struct alignas(64) Factors {
  std::array<std::array<double, 2 * kLane>, 3> v{};

  void set(std::size_t k, const Vec3& n) {
    for (std::size_t i = 0; i < 3; ++i) v[i][k] = n[static_cast<Eigen::Index>(i)];
  }
  TEGOTAE_INLINE Lane lane(std::size_t axis, std::size_t first) const {
    return *reinterpret_cast<const Lane*>(v[axis].data() + first);
  }
  TEGOTAE_INLINE Lanes3 lanes(std::size_t first) const { return {lane(0, first), lane(1, first), lane(2, first)}; }
};
/// How far apart the triangles are along the products, times their lengths, and the squares of these.
struct alignas(64) Apart {
  std::array<double, 2 * kLane> gap, length2;
};

TEGOTAE_INLINE Lane dot(const Lanes3& n, const Vec3& p) {
  return n.x * p.x() + n.y * p.y() + n.z * p.z();
}
TEGOTAE_INLINE Lane lesser(Lane a, Lane b) {
  return a < b ? a : b;
}
TEGOTAE_INLINE Lane greater(Lane a, Lane b) {
  return a > b ? a : b;
}

TEGOTAE_WIDE void measure_products(const Factors& left, const Factors& right, const std::array<Vec3, 3>& p,
                                   const std::array<Vec3, 3>& q, Apart& out) {
  for (std::size_t first = 0; first < 2 * kLane; first += kLane) {
    const Lanes3 x = left.lanes(first), y = right.lanes(first);
    const Lanes3 n{x.y * y.z - x.z * y.y, x.z * y.x - x.x * y.z, x.x * y.y - x.y * y.x};
    const Lane a0 = dot(n, p[0]), a1 = dot(n, p[1]), a2 = dot(n, p[2]);
    const Lane b0 = dot(n, q[0]), b1 = dot(n, q[1]), b2 = dot(n, q[2]);
    const Lane up = lesser(lesser(a0, a1), a2) - greater(greater(b0, b1), b2);
    const Lane down = lesser(lesser(b0, b1), b2) - greater(greater(a0, a1), a2);
    *reinterpret_cast<Lane*>(out.gap.data() + first) = greater(up, down);
    *reinterpret_cast<Lane*>(out.length2.data() + first) = n.x * n.x + n.y * n.y + n.z * n.z;
  }
}

/// Directions across edges, all or those that the start does not rule out as the best for both ends; offered to
/// `search` with their counterparts at the end. With the normals they can separate any two triangles that are apart.
void offer_products(const TrianglePair& t, Axes which, Search& search) {
  const Edges a0(t.p0), a1(t.p1), b(t.q);
  std::array<Product, kProducts> products;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) products[count++] = {&a0.e[i], &b.e[j], &a1.e[i], &b.e[j], false};
  for (std::size_t i = 0; i < 3; ++i) {
    products[count++] = {&b.n, &b.e[i], &b.n, &b.e[i], false};
    products[count++] = {&a0.n, &a0.e[i], &a1.n, &a1.e[i], true};
  }
  Factors left, right;
  for (std::size_t k = 0; k < kProducts; ++k) {
    left.set(k, *products[k].left0);
    right.set(k, *products[k].right0);
  }
  Apart apart;
  measure_products(left, right, t.p0, t.q, apart);
  double size = 0;
  for (const Vec3& v : t.p0) size = std::max(size, v.lpNorm<1>());
  for (const Vec3& v : t.q) size = std::max(size, v.lpNorm<1>());
  for (std::size_t k = 0; k < kProducts; ++k) {
    const Product& p = products[k];
    const double length = std::sqrt(apart.length2[k]);
    if (which == Axes::promising && !(apart.gap[k] > length * (search.both() - kProductSlack * size))) continue;
    const double parallel2 = kParallelEdges * kParallelEdges * p.right0->squaredNorm();
    const Vec3 m1 = p.left1->cross(*p.right1);
    if (!(apart.length2[k] > parallel2 * p.left0->squaredNorm() &&
          m1.squaredNorm() > parallel2 * p.left1->squaredNorm()))
      continue;
    search.offer_both_ways(p.left0->cross(*p.right0) / length, m1.normalized(), p.with_a);
  }
}

/// Whether no direction across two edges, or across a normal and an edge, keeps two triangles apart.
bool overlap_across_edges(const std::array<Vec3, 3>& p, const std::array<Vec3, 3>& q) {
  const Edges a(p), b(q);
  Factors left, right;
  std::array<double, kProducts> least2;  // shorter products have no reliable direction
  std::size_t count = 0;
  const auto add = [&](const Vec3& x, const Vec3& y) {
    left.set(count, x);
    right.set(count, y);
    least2[count++] = kParallelEdges * kParallelEdges * x.squaredNorm() * y.squaredNorm();
  };
  for (const Vec3& x : a.e)
    for (const Vec3& y : b.e) add(x, y);
  for (std::size_t i = 0; i < 3; ++i) {
    add(b.n, b.e[i]);
    add(a.n, a.e[i]);
  }
  Apart apart;
  measure_products(left, right, p, q, apart);
  for (std::size_t k = 0; k < kProducts; ++k)
    if (apart.gap[k] >= 0 && apart.length2[k] > least2[k]) return false;
  return true;
}

void offer_closest(const TrianglePair& t, Search& search) {
  const Vec3 n0 = edge_direction(t.p0, t.q), n1 = edge_direction(t.p1, t.q);
  if (!n0.isZero(0) && !n1.isZero(0)) search.offer({n0, n1});
}

bool separate_part(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, const Sweep& sweep, double reach,
                   double s0, const Placement& from, double s1, const Placement& to, int halvings,
                   const MovingPlane* beside, MovingPlane& plane) {
  const TrianglePair pair(a, b, from, to);
  const Bulge bulge(sweep, reach, s0, s1);
  if (stays_apart(pair, plane.n0, plane.n1, bulge, sweep, 0)) return true;
  if (beside != nullptr && stays_apart(pair, beside->n0, beside->n1, bulge, sweep, 0)) {
    plane = *beside;
    return true;
  }
  Search search(pair);
  search.offer(plane);
  offer_normals(pair, search);
  if (search.accept(bulge, sweep, plane)) return true;
  // The axes are complete, but for triangles without a plane; and most of what is in the way is so at the end.
  const auto complete = [&a, &b] { return !degenerate(a) && !degenerate(b); };
  if (search.end() < 0 && overlap_across_edges(pair.p1, pair.q) && complete()) return false;
  // What is best for both ends is among the promising ones, but what is best for one end need not be.
  offer_products(pair, Axes::promising, search);
  if (search.accept_together(bulge, sweep, plane)) return true;
  offer_products(pair, Axes::all, search);
  if (search.accept(bulge, sweep, plane)) return true;
  if (search.end() < 0 && complete()) return false;
  offer_closest(pair, search);
  if (search.accept(bulge, sweep, plane)) return true;
  if (search.end() < sweep.floor || search.start() < sweep.start_floor || halvings == 0) return false;
  const double s = 0.5 * (s0 + s1);
  const Placement middle = sweep.at(s);
  MovingPlane first{search.best().n0, search.best().n0};
  if (!separate_part(a, b, sweep, reach, s0, from, s, middle, halvings - 1, nullptr, first)) return false;
  MovingPlane second{first.n1, first.n1};
  if (!separate_part(a, b, sweep, reach, s, middle, s1, to, halvings - 1, nullptr, second)) return false;
  plane = second;
  return true;
}

}  // namespace

TrianglePair::TrianglePair(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, const Placement& from,
                           const Placement& to)
    : q(b) {
  for (int i = 0; i < 3; ++i) {
    p0[i] = from.R * a[i] + from.t;
    p1[i] = to.R * a[i] + to.t;
  }
}

double TrianglePair::start(const Vec3& n) const {
  return least(n, p0) - largest(n, q);
}
double TrianglePair::end(const Vec3& n) const {
  return least(n, p1) - largest(n, q);
}
double TrianglePair::mixed(const Vec3& n0, const Vec3& n1) const {
  double s = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) s = std::min(s, n0.dot(p1[i]) + n1.dot(p0[i]));
  return s - largest(n0, q) - largest(n1, q);
}

bool separate_triangles(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, const Sweep& sweep, double reach,
                        const MovingPlane* beside, MovingPlane& plane) {
  return separate_part(a, b, sweep, reach, 0, sweep.start, 1, sweep.end, kTimeHalvings, beside, plane);
}

}  // namespace tegotae
