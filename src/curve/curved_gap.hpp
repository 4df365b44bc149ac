#pragma once

// The gap of a pair in profile coordinates, for one number or a row of them at once: the derivation is in
// docs/decisions/0077-curved-certificate.md, and the names are those of the record. To be included where the wide
// passes are alone (a row is wider than the registers of a baseline processor).

#include <array>
#include <cmath>
#include <cstdint>

#include "curve/axis_motion.hpp"
#include "curve/curved_fields.hpp"

#define TEGOTAE_CURVE_INLINE __attribute__((always_inline)) inline

namespace tegotae {

namespace curve {

typedef double Lane __attribute__((vector_size(kCurvedLanes * sizeof(double))));
typedef std::int64_t LaneBits __attribute__((vector_size(kCurvedLanes * sizeof(double))));
typedef double LaneInMemory __attribute__((vector_size(kCurvedLanes * sizeof(double)), may_alias));

TEGOTAE_CURVE_INLINE double magnitude(double x) {
  return std::fabs(x);
}
TEGOTAE_CURVE_INLINE Lane magnitude(Lane x) {
  return (Lane)((LaneBits)x & 0x7fffffffffffffff);
}

template <typename V>
TEGOTAE_CURVE_INLINE V lesser(V a, V b) {
  return a < b ? a : b;
}
template <typename V>
TEGOTAE_CURVE_INLINE V greater(V a, V b) {
  return a > b ? a : b;
}

/// Not less than √(x² + y²), nor 9 % more.
template <typename V>
TEGOTAE_CURVE_INLINE V length_bound(V x, V y) {
  const V a = magnitude(x), b = magnitude(y);
  return greater(a, b) + 0.41421357 * lesser(a, b);
}

/// A's piece, one field after the other.
template <typename V>
struct Piece {
  V z_low, z_high, r, r_half, r_low, r_high, inverse, inverse_low, cos, sin, cos_half, sin_half;
};

/// What a pose does to A's piece, whatever the direction.
template <typename V>
struct PosedPiece {
  V x[2], y[2];  ///< offset of the axis at both ends of the piece
  V cos, sin;    ///< of the azimuth in B's frame
  V offset;      ///< E: not less than what offset and tilt move a point across the axis
};

template <typename V>
TEGOTAE_CURVE_INLINE PosedPiece<V> posed(const Piece<V>& a, const AxisPose& q) {
  PosedPiece<V> p;
  p.x[0] = q.offset_x + q.lean_x * a.z_low;
  p.y[0] = q.offset_y + q.lean_y * a.z_low;
  p.x[1] = q.offset_x + q.lean_x * a.z_high;
  p.y[1] = q.offset_y + q.lean_y * a.z_high;
  p.cos = a.cos * q.cos_psi - a.sin * q.sin_psi;
  p.sin = a.sin * q.cos_psi + a.cos * q.sin_psi;
  p.offset = greater(length_bound(p.x[0], p.y[0]), length_bound(p.x[1], p.y[1])) + q.lean2 * a.r_high;
  return p;
}

/// Least of C cos θ + S sin θ over the piece's arc.
template <typename V>
TEGOTAE_CURVE_INLINE V least_on_arc(const Piece<V>& a, const PosedPiece<V>& p, V C, V S) {
  const V middle = C * p.cos + S * p.sin, across = magnitude(S * p.cos - C * p.sin);
  const V arc = lesser(middle, middle * a.cos_half) - across * a.sin_half;
  const V all = -length_bound(C, S);
  return a.cos_half < V{} ? all : arc;
}

/// Gap along one direction at one end of the motion.
template <typename V>
TEGOTAE_CURVE_INLINE V gap_at(const Piece<V>& a, const PosedPiece<V>& p, const AxisPose& q, double rise, V alpha,
                              V beta, V base) {
  const V steep = beta * rise * a.inverse;
  V least[2];
  for (int i = 0; i < 2; ++i) {
    const V C = alpha * p.x[i] - beta * (q.lean_x * a.r) - steep * p.y[i];
    const V S = alpha * p.y[i] - beta * (q.lean_y * a.r) + steep * p.x[i];
    least[i] = least_on_arc(a, p, C, S);
  }
  const V alpha_abs = magnitude(alpha), beta_abs = magnitude(beta), turn_abs = magnitude(beta * rise);
  // Other radii of the piece than the middle one.
  const V radii = a.r_half * (beta_abs * q.lean + turn_abs * p.offset * a.inverse * a.inverse_low);
  const V z_abs = greater(magnitude(a.z_low), magnitude(a.z_high));
  const V tilt = q.lean2 * (alpha_abs * a.r_high + beta_abs * z_abs + 0.5 * turn_abs);
  const V square = p.offset * p.offset * a.inverse_low;
  // A point off the axis by E is farther from it than first order says, never nearer.
  const V outward = 0.5 * lesser(alpha, V{}) * square;  // ≤ 0
  const V angle = (7.0 / 3.0) * turn_abs * square * a.inverse_low;
  return base + beta * q.shift + lesser(least[0], least[1]) - radii - tilt + outward - angle;
}

/// The margin of a pair along one direction over the whole motion: positive means apart by more than the floor.
template <typename V>
TEGOTAE_CURVE_INLINE V margin_of(const Piece<V>& a, const PosedPiece<V>& p0, const PosedPiece<V>& p1,
                                 const AxisMotion& m, V alpha, V beta, V base) {
  const V offset = greater(p0.offset, p1.offset);
  const V r_path = a.r_low - offset - 0.5 * m.speed;  // no point of the piece comes nearer to B's axis
  const V inverse = 1.0 / greater(r_path, 1e-3 * a.r_low);
  const V rise = magnitude(m.rise * inverse);
  const V acceleration = m.acceleration + m.speed * m.speed * inverse;
  const V bulge = 0.125 * (magnitude(alpha) * acceleration + magnitude(beta) * (m.vertical + rise * acceleration));
  const V stretch = 1.0 + rise * rise;  // a gap along the direction against a distance
  const V start = gap_at(a, p0, m.start, m.rise, alpha, beta, base) - m.start_floor * stretch;
  const V end = gap_at(a, p1, m.end, m.rise, alpha, beta, base) - m.floor * stretch;
  // What the derivation needs: E ≤ r_lo / 2 at both ends, speed ≤ r on the path.
  const V allowed = lesser(a.r_low - 2.0 * offset, r_path - m.speed);
  return lesser(allowed, lesser(start, end) - bulge);
}

}  // namespace curve
}  // namespace tegotae
