#include "narrowphase/patch_lanes.hpp"

#include "narrowphase/wide.hpp"

namespace tegotae {
namespace {

typedef float Lane __attribute__((vector_size(kLanes * sizeof(float)), may_alias));
typedef std::int32_t LaneBits __attribute__((vector_size(kLanes * sizeof(float)), may_alias));
typedef double FineLane __attribute__((vector_size(kLanes * sizeof(double)), may_alias));
typedef std::int64_t FineBits __attribute__((vector_size(kLanes * sizeof(double)), may_alias));

/// One field of a block in the precision of V.
template <typename V>
TEGOTAE_INLINE V load(const float* block, std::size_t field) {
  return __builtin_convertvector(*reinterpret_cast<const Lane*>(block + field * kLanes), V);
}
TEGOTAE_INLINE Lane magnitude(Lane x) {
  return (Lane)((LaneBits)x & 0x7fffffff);
}
TEGOTAE_INLINE FineLane magnitude(FineLane x) {
  return (FineLane)((FineBits)x & 0x7fffffffffffffff);
}
template <typename V>
TEGOTAE_INLINE V lesser(V a, V b) {
  return a < b ? a : b;
}

/// Gap between A's box at (R, t) and the plane.
template <typename V, typename Real>
TEGOTAE_INLINE V box_gap(const float* f, const Real* R, const Real* t) {
  const V n0 = load<V>(f, kBoxNormal), n1 = load<V>(f, kBoxNormal + 1), n2 = load<V>(f, kBoxNormal + 2);
  const V m0 = n0 * R[0] + n1 * R[3] + n2 * R[6];
  const V m1 = n0 * R[1] + n1 * R[4] + n2 * R[7];
  const V m2 = n0 * R[2] + n1 * R[5] + n2 * R[8];
  V gap = n0 * t[0] + n1 * t[1] + n2 * t[2] - load<V>(f, kBoxOffset);
  gap += m0 * load<V>(f, kBoxCenter) + m1 * load<V>(f, kBoxCenter + 1) + m2 * load<V>(f, kBoxCenter + 2);
  for (std::size_t k = kBoxEdges; k < kBoxEdges + 9; k += 3) {
    gap -= magnitude(m0 * load<V>(f, k) + m1 * load<V>(f, k + 1) + m2 * load<V>(f, k + 2));
  }
  return gap;
}

template <typename V, typename Real>
TEGOTAE_INLINE V triangle_gap(const float* f, const Real* R, const Real* t) {
  const V n0 = load<V>(f, kTriNormal), n1 = load<V>(f, kTriNormal + 1), n2 = load<V>(f, kTriNormal + 2);
  const V m0 = n0 * R[0] + n1 * R[3] + n2 * R[6];
  const V m1 = n0 * R[1] + n1 * R[4] + n2 * R[7];
  const V m2 = n0 * R[2] + n1 * R[5] + n2 * R[8];
  const std::size_t k = kTriCorners;
  const V a = m0 * load<V>(f, k) + m1 * load<V>(f, k + 1) + m2 * load<V>(f, k + 2);
  const V b = m0 * load<V>(f, k + 3) + m1 * load<V>(f, k + 4) + m2 * load<V>(f, k + 5);
  const V c = m0 * load<V>(f, k + 6) + m1 * load<V>(f, k + 7) + m2 * load<V>(f, k + 8);
  return n0 * t[0] + n1 * t[1] + n2 * t[2] - load<V>(f, kTriOffset) + lesser(lesser(a, b), c);
}

// A plane that stands still leaves the gap linear along the chord, and the arc takes at most ρθ²/8 off (see Bulge).
template <typename V, typename Real>
TEGOTAE_INLINE V box_margin(const float* f, const LaneMotion<Real>& s) {
  const V gap = lesser(box_gap<V>(f, s.R0.data(), s.t0.data()), box_gap<V>(f, s.R1.data(), s.t1.data()));
  return gap - load<V>(f, kBoxReach) * s.bulge - (s.bulge_offset + s.error);
}

template <typename V, typename Real>
TEGOTAE_INLINE V triangle_margin(const float* f, const LaneMotion<Real>& s) {
  const V gap = lesser(triangle_gap<V>(f, s.R0.data(), s.t0.data()), triangle_gap<V>(f, s.R1.data(), s.t1.data()));
  return gap - load<V>(f, kTriReach) * s.bulge - (s.bulge_offset + s.error);
}

TEGOTAE_INLINE bool all_positive(Lane x) {
  // Halved as vectors: from a loop over the lanes the compiler makes one move each.
  typedef std::int64_t Words __attribute__((vector_size(kLanes * sizeof(float)), may_alias));
  const Words failed = (Words) ~(x > 0);
  const auto four =
      __builtin_shufflevector(failed, failed, 0, 1, 2, 3) | __builtin_shufflevector(failed, failed, 4, 5, 6, 7);
  const auto two = __builtin_shufflevector(four, four, 0, 1) | __builtin_shufflevector(four, four, 2, 3);
  return (two[0] | two[1]) == 0;
}

/// Appends the lanes of a block that do not stay positive.
TEGOTAE_INLINE std::size_t append_failures(Lane margin, std::size_t slot, std::size_t end, std::uint32_t* out) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < kLanes && slot + i < end; ++i) {
    out[n] = static_cast<std::uint32_t>(slot + i);
    n += !(margin[i] > 0);
  }
  return n;
}

}  // namespace

TEGOTAE_WIDE std::size_t box_failures(const LaneBlocks& pairs, std::size_t first, std::size_t end,
                                      const LaneSweep& sweep, std::uint32_t* failed) {
  const float* f = pairs.block(first);
  std::size_t n = 0;
  for (std::size_t i = first; i < end; i += kLanes, f += kBoxFields * kLanes) {
    if (all_positive(box_margin<Lane>(f, sweep.coarse))) continue;
    n += append_failures(__builtin_convertvector(box_margin<FineLane>(f, sweep.fine), Lane), i, end, failed + n);
  }
  return n;
}

TEGOTAE_WIDE std::size_t triangle_failures(const LaneBlocks& pairs, std::size_t first, std::size_t end,
                                           const LaneSweep& sweep, std::uint32_t* failed) {
  const float* f = pairs.block(first);
  std::size_t n = 0;
  for (std::size_t i = first; i < end; i += kLanes, f += kTriFields * kLanes) {
    if (all_positive(triangle_margin<Lane>(f, sweep.coarse))) continue;
    n += append_failures(__builtin_convertvector(triangle_margin<FineLane>(f, sweep.fine), Lane), i, end, failed + n);
  }
  return n;
}

}  // namespace tegotae
