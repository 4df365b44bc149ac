#include <algorithm>
#include <cmath>
#include <limits>

#include "narrowphase/moving_plane.hpp"

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

  /// Whether the direction of the start has the triangles farther apart there than any that is known has at both ends:
  /// only then can it be the best for both ends at once.
  bool promises(const Vec3& n0) const {
    const Span a(n0, pair_.p0), b(n0, pair_.q);
    return std::max(a.lo - b.hi, b.lo - a.hi) > both_;
  }

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

struct Edges {
  std::array<Vec3, 3> e;
  Vec3 n;  ///< unit or zero

  explicit Edges(const std::array<Vec3, 3>& v) {
    double longest = 0;
    for (int i = 0; i < 3; ++i) {
      e[i] = v[(i + 1) % 3] - v[i];
      longest = std::max(longest, e[i].squaredNorm());
    }
    n = e[0].cross(e[1]);
    const double l = n.norm();
    n = l > kParallelEdges * kParallelEdges * longest ? Vec3(n / l) : Vec3(Vec3::Zero());
    for (Vec3& x : e) {
      const double length = x.norm();
      if (length > 0) x /= length;
    }
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

/// Directions that can separate two triangles, all or those that the start does not rule out as the best for both ends;
/// offered to `search` with their counterparts at the end.
void offer_triangle_axes(const TrianglePair& t, Axes which, Search& search) {
  const Edges a0(t.p0), a1(t.p1), b(t.q);
  if (!b.n.isZero(0)) search.offer_both_ways(b.n, b.n, false);
  if (!a0.n.isZero(0)) search.offer_both_ways(a0.n, a1.n, true);
  auto product = [&](const Vec3& x0, const Vec3& y0, const Vec3& x1, const Vec3& y1, bool with_a) {
    const Vec3 m0 = x0.cross(y0);
    const double l0 = m0.norm();
    if (l0 < kParallelEdges) return;
    const Vec3 n0 = m0 / l0;
    if (which == Axes::promising && !search.promises(n0)) return;
    const Vec3 m1 = x1.cross(y1);
    const double l1 = m1.norm();
    if (l1 < kParallelEdges) return;
    search.offer_both_ways(n0, m1 / l1, with_a);
  };
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) product(a0.e[i], b.e[j], a1.e[i], b.e[j], false);
  }
  for (int i = 0; i < 3; ++i) {
    product(b.n, b.e[i], b.n, b.e[i], false);
    product(a0.n, a0.e[i], a1.n, a1.e[i], true);
  }
}

void offer_closest(const TrianglePair& t, Search& search) {
  const Vec3 n0 = edge_direction(t.p0, t.q), n1 = edge_direction(t.p1, t.q);
  if (!n0.isZero(0) && !n1.isZero(0)) search.offer({n0, n1});
}

bool separate_part(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, const Sweep& sweep, double reach,
                   double s0, const Placement& from, double s1, const Placement& to, int halvings, MovingPlane& plane) {
  const TrianglePair pair(a, b, from, to);
  const Bulge bulge(sweep, reach, s0, s1);
  if (stays_apart(pair, plane.n0, plane.n1, bulge, sweep, 0)) return true;
  Search search(pair);
  search.offer(plane);
  offer_normals(pair, search);
  if (search.accept(bulge, sweep, plane)) return true;
  // What is best for both ends is among the promising ones, but what is best for one end need not be.
  offer_triangle_axes(pair, Axes::promising, search);
  if (search.accept_together(bulge, sweep, plane)) return true;
  offer_triangle_axes(pair, Axes::all, search);
  if (search.accept(bulge, sweep, plane)) return true;
  // The axes are complete, but for triangles without a plane.
  if (search.end() < 0 && !degenerate(a) && !degenerate(b)) return false;
  offer_closest(pair, search);
  if (search.accept(bulge, sweep, plane)) return true;
  if (search.end() < sweep.floor || search.start() < sweep.start_floor || halvings == 0) return false;
  const double s = 0.5 * (s0 + s1);
  const Placement middle = sweep.at(s);
  MovingPlane first{search.best().n0, search.best().n0};
  if (!separate_part(a, b, sweep, reach, s0, from, s, middle, halvings - 1, first)) return false;
  MovingPlane second{first.n1, first.n1};
  if (!separate_part(a, b, sweep, reach, s, middle, s1, to, halvings - 1, second)) return false;
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
                        MovingPlane& plane) {
  return separate_part(a, b, sweep, reach, 0, sweep.start, 1, sweep.end, kTimeHalvings, plane);
}

}  // namespace tegotae
