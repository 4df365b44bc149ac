#include <cmath>
#include <cstddef>
#include <cstring>

#include "narrowphase/moving_plane.hpp"
#include "narrowphase/wide.hpp"

namespace tegotae {
namespace {

/// A number of each of the two pairs at the start of the motion, then of each at its end.
typedef double Ends __attribute__((vector_size(4 * sizeof(double))));
typedef std::int64_t EndBits __attribute__((vector_size(4 * sizeof(double))));

template <typename V>
TEGOTAE_INLINE V other_end(V v) {
  return __builtin_shufflevector(v, v, 2, 3, 0, 1);
}
TEGOTAE_INLINE Ends magnitude(Ends v) {
  return (Ends)((EndBits)v & 0x7fffffffffffffff);
}
TEGOTAE_INLINE Ends root(Ends v) {
  for (int i = 0; i < 4; ++i) v[i] = std::sqrt(v[i]);
  return v;
}
TEGOTAE_INLINE bool none(EndBits m) {
  return (m[0] | m[1] | m[2] | m[3]) == 0;
}

struct Vectors {
  Ends x, y, z;
};

TEGOTAE_INLINE Ends dot(const Vectors& a, const Vectors& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
TEGOTAE_INLINE Vectors choose(EndBits m, const Vectors& a, const Vectors& b) {
  return {m ? a.x : b.x, m ? a.y : b.y, m ? a.z : b.z};
}
TEGOTAE_INLINE Vectors negated(EndBits m, const Vectors& v) {
  return {m ? -v.x : v.x, m ? -v.y : v.y, m ? -v.z : v.z};
}
TEGOTAE_INLINE Vectors other_end(const Vectors& v) {
  return {other_end(v.x), other_end(v.y), other_end(v.z)};
}

/// Boxes of A as boxes of B see them: the way from B's center to A's, the axes of both, half extents.
struct Boxes {
  Vectors way, a[3], b[3];
  Ends ha[3], hb[3];
  Ends between;  ///< see Bulge; at the ends of a motion there is none
};

/// Numbers of each pair that are the same at both ends, and one of all pairs that is not.
TEGOTAE_INLINE Ends of_pairs(double first, double second) {
  return Ends{first, second, first, second};
}
TEGOTAE_INLINE Ends at_ends(double start, double end) {
  return Ends{start, start, end, end};
}
TEGOTAE_INLINE Ends of_all(double x) {
  return Ends{x, x, x, x};
}

struct Row {
  Ends v[4];
};

/// Four numbers in a row of each node, from its `first` one on.
template <int first>
TEGOTAE_INLINE Row load(const PatchNode& one, const PatchNode& two) {
  typedef float Floats __attribute__((vector_size(4 * sizeof(float))));
  Floats r, q;
  std::memcpy(&r, reinterpret_cast<const char*>(&one) + first * sizeof(float), sizeof r);
  std::memcpy(&q, reinterpret_cast<const char*>(&two) + first * sizeof(float), sizeof q);
  const Ends a = __builtin_convertvector(r, Ends), b = __builtin_convertvector(q, Ends);
  return {{__builtin_shufflevector(a, b, 0, 4, 0, 4), __builtin_shufflevector(a, b, 1, 5, 1, 5),
           __builtin_shufflevector(a, b, 2, 6, 2, 6), __builtin_shufflevector(a, b, 3, 7, 3, 7)}};
}

/// Axes and half extents of a box of each pair.
struct Shapes {
  Vectors axis[3];
  Ends half[3];

  TEGOTAE_INLINE Shapes(const PatchNode& one, const PatchNode& two) {
    static_assert(offsetof(PatchNode, axis) == 3 * sizeof(float) && offsetof(PatchNode, half) == 12 * sizeof(float));
    const Row r = load<3>(one, two), s = load<7>(one, two), t = load<11>(one, two);
    axis[0] = {r.v[0], r.v[1], r.v[2]};
    axis[1] = {r.v[3], s.v[0], s.v[1]};
    axis[2] = {s.v[2], s.v[3], t.v[0]};
    for (int k = 0; k < 3; ++k) half[k] = t.v[1 + k];
  }
};

TEGOTAE_INLINE Boxes seen(const BoxPair& one, const BoxPair& two, const Sweep& sweep) {
  const Shapes a(one.a, two.a), b(one.b, two.b);
  const Row center_b = load<0>(one.b, two.b);
  const Vectors center_a = {of_pairs(one.center_a.x(), two.center_a.x()), of_pairs(one.center_a.y(), two.center_a.y()),
                            of_pairs(one.center_a.z(), two.center_a.z())};
  const Mat3 &R = sweep.start.R, &Q = sweep.end.R;
  const Vec3 &t = sweep.start.t, &u = sweep.end.t;
  Boxes s;
  Vectors row[3];
  for (int i = 0; i < 3; ++i)
    row[i] = {at_ends(R(i, 0), Q(i, 0)), at_ends(R(i, 1), Q(i, 1)), at_ends(R(i, 2), Q(i, 2))};
  for (int k = 0; k < 3; ++k) {
    s.a[k] = {dot(row[0], a.axis[k]), dot(row[1], a.axis[k]), dot(row[2], a.axis[k])};
    s.b[k] = b.axis[k];
    s.ha[k] = a.half[k];
    s.hb[k] = b.half[k];
  }
  s.way = {dot(row[0], center_a) + (at_ends(t.x(), u.x()) - center_b.v[0]),
           dot(row[1], center_a) + (at_ends(t.y(), u.y()) - center_b.v[1]),
           dot(row[2], center_a) + (at_ends(t.z(), u.z()) - center_b.v[2])};
  s.between = of_pairs(Bulge(sweep, one.reach, 0, 1).between, Bulge(sweep, two.reach, 0, 1).between);
  return s;
}

/// Half of what both boxes of each pair measure along something, given what each axis does.
TEGOTAE_INLINE Ends span(const Ends* ha, const Ends& a0, const Ends& a1, const Ends& a2, const Ends* hb, const Ends& b0,
                         const Ends& b1, const Ends& b2) {
  return (hb[0] * b0 + (ha[1] * a1 + hb[2] * b2)) + ((ha[0] * a0 + hb[1] * b1) + ha[2] * a2);
}

/// See stays_apart() of moving_plane.hpp: the same for each pair, with the normals `n` at the two ends.
TEGOTAE_INLINE EndBits stay_apart(const Boxes& s, const Vectors& n, const Sweep& sweep, const Vectors& axis,
                                  const Ends& floors, double spare) {
  const Ends b[3] = {magnitude(dot(n, s.b[0])), magnitude(dot(n, s.b[1])), magnitude(dot(n, s.b[2]))};
  const Ends gap = dot(n, s.way) - span(s.ha, magnitude(dot(n, s.a[0])), magnitude(dot(n, s.a[1])),
                                        magnitude(dot(n, s.a[2])), s.hb, b[0], b[1], b[2]);
  const Ends left = gap - spare - floors;
  EndBits good = left >= 0;
  good &= other_end(good);
  if (none(good)) return good;
  const Vectors across = {axis.y * n.z - axis.z * n.y, axis.z * n.x - axis.x * n.z, axis.x * n.y - axis.y * n.x};
  const Ends part2 = across.x * across.x + (across.y * across.y + across.z * across.z);
  const Ends most = part2 < other_end(part2) ? other_end(part2) : part2;
  const Ends share = root(most);
  const Vectors m = other_end(n);
  const auto both = [&](const Vectors& v) {
    const Ends along = dot(m, v);
    return along + other_end(along);
  };
  const Ends mixed = both(s.way) - span(s.ha, magnitude(both(s.a[0])), magnitude(both(s.a[1])), magnitude(both(s.a[2])),
                                        s.hb, b[0] + other_end(b[0]), b[1] + other_end(b[1]), b[2] + other_end(b[2]));
  const Ends gamma = 0.5 * (mixed - share * s.between) - spare - sweep.floor;
  return good & (gamma + root(left * other_end(left)) >= 0);
}

/// The answer to the pair of number `p`, if the normals `n` keep it apart.
TEGOTAE_INLINE void answer(int p, EndBits apart, const Vectors& n, EndBits with_a, BoxPair& pair) {
  if (apart[p] == 0) return;
  pair.apart = true;
  pair.plane = {Vec3(n.x[p], n.y[p], n.z[p]), Vec3(n.x[p + 2], n.y[p + 2], n.z[p + 2]), with_a[p + 2] != 0};
}

}  // namespace

TEGOTAE_WIDE void separate_boxes(BoxPair& one, BoxPair& two, const Sweep& sweep, double spare, double worth_of_a) {
  const Boxes s = seen(one, two, sweep);
  const Vectors axis = {of_all(sweep.axis.x()), of_all(sweep.axis.y()), of_all(sweep.axis.z())};
  const Ends floors = at_ends(sweep.start_floor, sweep.floor);
  const MovingPlane &p = one.plane, &q = two.plane;
  const Vectors known = {Ends{p.n0.x(), q.n0.x(), p.n1.x(), q.n1.x()}, Ends{p.n0.y(), q.n0.y(), p.n1.y(), q.n1.y()},
                         Ends{p.n0.z(), q.n0.z(), p.n1.z(), q.n1.z()}};
  const EndBits still = stay_apart(s, known, sweep, axis, floors, spare), open = ~still;
  one.apart = still[0] != 0;
  two.apart = still[1] != 0;
  if (none(open)) return;

  // The faces, B's first: which has the largest gap at each end, and which where its lesser one is.
  Ends along[6], sep[6];
  Ends of_a[3] = {s.ha[0], s.ha[1], s.ha[2]};
  for (int i = 0; i < 3; ++i) {
    along[i] = dot(s.b[i], s.way);
    const Ends m[3] = {magnitude(dot(s.b[i], s.a[0])), magnitude(dot(s.b[i], s.a[1])), magnitude(dot(s.b[i], s.a[2]))};
    sep[i] = magnitude(along[i]) - (s.hb[i] + (s.ha[1] * m[1] + (s.ha[0] * m[0] + s.ha[2] * m[2])));
    for (int k = 0; k < 3; ++k) of_a[k] += s.hb[i] * m[k];
  }
  for (int k = 0; k < 3; ++k) {
    along[3 + k] = dot(s.way, s.a[k]);
    sep[3 + k] = magnitude(along[3 + k]) - of_a[k];
  }
  const Ends zero = {};
  Ends best = sep[0], both = zero;
  Vectors own = negated(along[0] < 0, s.b[0]), together = {zero, zero, zero};
  EndBits own_a = {}, together_a = {};
  for (int k = 0; k < 6; ++k) {
    const EndBits back = along[k] < 0;
    const Vectors normal = negated(back, k < 3 ? s.b[k] : s.a[k - 3]);
    const EndBits is_a = k < 3 ? EndBits{} : ~EndBits{};
    const EndBits better = sep[k] > best;
    best = better ? sep[k] : best;
    own = choose(better, normal, own);
    own_a = better ? is_a : own_a;
    const Ends lesser = other_end(sep[k]) < sep[k] ? other_end(sep[k]) : sep[k];
    const Ends worth = k < 3 ? lesser : worth_of_a * lesser;
    const EndBits more = (worth > both) & (back == other_end(back));
    both = more ? worth : both;
    together = choose(more, normal, together);
    together_a = more ? is_a : together_a;
  }
  EndBits may = best > 0;
  may &= other_end(may) & open;
  const EndBits any = may & (both > 0);
  if (!none(any)) {
    const EndBits good = any & stay_apart(s, together, sweep, axis, floors, spare);
    answer(0, good, together, together_a, one);
    answer(1, good, together, together_a, two);
    may &= ~good;
  }
  if (none(may)) return;
  const EndBits good = may & stay_apart(s, own, sweep, axis, floors, spare);
  answer(0, good, own, own_a, one);
  answer(1, good, own, own_a, two);
}

}  // namespace tegotae
