// Planes between boxes in motion, against their corners followed along the motion in extended precision.
#include "catch.hpp"
#include "random_motion.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

using Corners = std::array<Real3, 8>;

PatchNode random_box(std::mt19937& rng, double size) {
  PatchNode box{};
  const Mat3 R = rotation(random_in_ball(rng, 3)).toRotationMatrix();
  for (int k = 0; k < 3; ++k) {
    box.half[k] = static_cast<float>(0.3 * size * std::pow(10.0, uniform(rng, -3, 0)));
    for (int j = 0; j < 3; ++j) box.axis[k][j] = static_cast<float>(R(j, k));
  }
  return box;
}

Corners corners(const PatchNode& box, const Vec3& center) {
  Corners c;
  for (std::size_t i = 0; i < 8; ++i) {
    c[i] = center.cast<long double>();
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j)
        c[i][j] += (i >> k & 1 ? 1 : -1) * static_cast<long double>(box.half[k]) * box.axis[k][j];
  }
  return c;
}

long double gap(const Real3& n, const Corners& a, const Motion::At& at, const Corners& b) {
  long double lowest = std::numeric_limits<long double>::infinity(), highest = -lowest;
  for (const Real3& x : a) lowest = std::min(lowest, n.dot(Real3(at.R * x + at.center)));
  for (const Real3& x : b) highest = std::max(highest, n.dot(x));
  return lowest - highest;
}

/// A box of A, one of B near where A's is at the start, and a plane from before.
struct Couple {
  PatchNode a, b;
  Vec3 center_a;
  MovingPlane known;

  Couple(std::mt19937& rng, const Motion& m) : a(random_box(rng, m.size)), b(random_box(rng, m.size)) {
    center_a = random_in_ball(rng, m.size);
    // Along a face of one of them or elsewhere, about as far apart as they are large, or as the motion takes off.
    const Mat3& R = m.sweep.start.R;
    const std::array<Vec3, 3> ways = {random_in_ball(rng, 1).normalized(), b.axis_vec(2), R * a.axis_vec(2)};
    const Vec3 way = ways[rng() % 3];
    double extent = 0;
    for (int k = 0; k < 3; ++k)
      extent += a.half[k] * std::abs(way.dot(R * a.axis_vec(k))) + b.half[k] * std::abs(way.dot(b.axis_vec(k)));
    const bool close = rng() % 2 == 0;
    const Vec3 aside = way * (close ? extent + uniform(rng, -0.05, 0.5) * taken(m) : extent * uniform(rng, 0.5, 2));
    const Vec3 center_b = R * center_a + m.sweep.start.t - aside;
    for (int k = 0; k < 3; ++k) b.center[k] = static_cast<float>(center_b[k]);
    known.n0 = known.n1 = (rng() % 2 == 0 ? random_in_ball(rng, 1) : way).normalized();
  }

  BoxPair pair() const {
    const double reach = center_a.norm() + Vec3(a.half[0], a.half[1], a.half[2]).norm() * (1 + 1e-6);
    return {a, b, center_a, reach, known};
  }
  /// What the motion may take off a gap, generously.
  double taken(const Motion& m) const {
    return m.sweep.theta2 *
               (m.size + center_a.norm() + m.sweep.start.t.norm() + m.sweep.end.t.norm() + m.center.norm()) +
           1e-6 * m.size;
  }
};

/// The largest of what a face of either box leaves at the lesser of both ends.
long double best_face(const Motion& m, const Couple& c) {
  const Corners a = corners(c.a, c.center_a), b = corners(c.b, c.b.center_vec());
  const Motion::At start = m.at(0, false), end = m.at(1, false);
  long double best = -std::numeric_limits<long double>::infinity();
  for (int k = 0; k < 3; ++k) {
    for (const int sign : {-1, 1}) {
      const Real3 of_b = sign * c.b.axis_vec(k).cast<long double>(), of_a = sign * c.a.axis_vec(k).cast<long double>();
      best = std::max({best, std::min(gap(of_b, a, start, b), gap(of_b, a, end, b)),
                       std::min(gap(start.R * of_a, a, start, b), gap(end.R * of_a, a, end, b))});
    }
  }
  return best;
}

long double least_gap(const Motion& m, const Couple& c, const MovingPlane& plane) {
  const Corners a = corners(c.a, c.center_a), b = corners(c.b, c.b.center_vec());
  long double least = std::numeric_limits<long double>::infinity();
  for (const bool by_origin : {false, true}) {
    for (int i = 0; i <= 16; ++i) {
      const long double s = i / 16.0L;
      const Real3 n = (1 - s) * plane.n0.cast<long double>() + s * plane.n1.cast<long double>();
      least = std::min(least, gap(n, a, m.at(s, by_origin), b));
    }
  }
  return least;
}

bool same(const BoxPair& x, const BoxPair& y) {
  return x.apart == y.apart && x.plane.n0 == y.plane.n0 && x.plane.n1 == y.plane.n1 && x.plane.with_a == y.plane.with_a;
}

}  // namespace

TEST_CASE("planes keep boxes apart all along a motion, whatever box is asked about beside them", "[patch]") {
  std::mt19937 rng(307);
  const PatchTree tree(soup(rng, 20, 0.05, 0.01));
  int apart = 0, clear = 0, wrong = 0, missed = 0, other = 0;
  constexpr int kMotions = 10000;
  for (int i = 0; i < kMotions; ++i) {
    const Motion m(rng, tree);
    const std::array<Couple, 2> couples = {Couple(rng, m), Couple(rng, m)};
    const double worth = i % 2 == 0 ? 1 : 0.5;
    BoxPair one = couples[0].pair(), two = couples[1].pair();
    separate_boxes(one, two, m.sweep, 0, worth);
    for (std::size_t k = 0; k < 2; ++k) {
      const Couple& c = couples[k];
      const BoxPair& pair = k == 0 ? one : two;
      BoxPair alone = c.pair();
      separate_boxes(alone, alone, m.sweep, 0, worth);
      other += !same(alone, pair);
      apart += pair.apart;
      if (pair.apart) wrong += !(least_gap(m, c, pair.plane) > 0);
      // A face of A counts half of what one of B does, so the face that is taken may leave half of the best.
      const bool plainly = best_face(m, c) > 4 * c.taken(m);
      clear += plainly;
      missed += plainly && !pair.apart;
    }
  }
  CAPTURE(apart, clear);
  CHECK(wrong == 0);
  CHECK(missed == 0);
  CHECK(other == 0);
  CHECK(apart > kMotions / 4);
  CHECK(clear > kMotions / 10);
}
