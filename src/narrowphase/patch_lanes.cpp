#include "narrowphase/patch_lanes.hpp"

#if defined(__x86_64__) && defined(__ELF__)
#define TEGOTAE_WIDE __attribute__((target_clones("default", "avx2", "avx512f")))
#else
#define TEGOTAE_WIDE
#endif

namespace tegotae {
namespace {

typedef float Lane __attribute__((vector_size(kLanes * sizeof(float)), may_alias));
typedef std::int32_t LaneBits __attribute__((vector_size(kLanes * sizeof(float)), may_alias));

#define TEGOTAE_INLINE __attribute__((always_inline)) inline

TEGOTAE_INLINE Lane load(const float* block, std::size_t field) {
  return *reinterpret_cast<const Lane*>(block + field * kLanes);
}
TEGOTAE_INLINE Lane magnitude(Lane x) {
  return (Lane)((LaneBits)x & 0x7fffffff);
}
TEGOTAE_INLINE Lane lesser(Lane a, Lane b) {
  return a < b ? a : b;
}

/// Gap between A's box at (R, t) and the plane.
TEGOTAE_INLINE Lane box_gap(const float* f, const float* R, const float* t) {
  const Lane n0 = load(f, kBoxNormal), n1 = load(f, kBoxNormal + 1), n2 = load(f, kBoxNormal + 2);
  const Lane m0 = n0 * R[0] + n1 * R[3] + n2 * R[6];
  const Lane m1 = n0 * R[1] + n1 * R[4] + n2 * R[7];
  const Lane m2 = n0 * R[2] + n1 * R[5] + n2 * R[8];
  Lane gap = n0 * t[0] + n1 * t[1] + n2 * t[2] - load(f, kBoxOffset);
  gap += m0 * load(f, kBoxCenter) + m1 * load(f, kBoxCenter + 1) + m2 * load(f, kBoxCenter + 2);
  for (std::size_t k = kBoxEdges; k < kBoxEdges + 9; k += 3) {
    gap -= magnitude(m0 * load(f, k) + m1 * load(f, k + 1) + m2 * load(f, k + 2));
  }
  return gap;
}

TEGOTAE_INLINE Lane triangle_gap(const float* f, const float* R, const float* t) {
  const Lane n0 = load(f, kTriNormal), n1 = load(f, kTriNormal + 1), n2 = load(f, kTriNormal + 2);
  const Lane m0 = n0 * R[0] + n1 * R[3] + n2 * R[6];
  const Lane m1 = n0 * R[1] + n1 * R[4] + n2 * R[7];
  const Lane m2 = n0 * R[2] + n1 * R[5] + n2 * R[8];
  const std::size_t k = kTriCorners;
  const Lane a = m0 * load(f, k) + m1 * load(f, k + 1) + m2 * load(f, k + 2);
  const Lane b = m0 * load(f, k + 3) + m1 * load(f, k + 4) + m2 * load(f, k + 5);
  const Lane c = m0 * load(f, k + 6) + m1 * load(f, k + 7) + m2 * load(f, k + 8);
  return n0 * t[0] + n1 * t[1] + n2 * t[2] - load(f, kTriOffset) + lesser(lesser(a, b), c);
}

}  // namespace

// A plane that stands still leaves the gap linear along the chord, and the arc takes at most ρθ²/8 off (see Bulge).
TEGOTAE_WIDE void box_margins(const LaneBlocks& pairs, std::size_t count, const LaneSweep& sweep, float* margins) {
  const float* f = pairs.data();
  for (std::size_t i = 0; i < count; i += kLanes, f += kBoxFields * kLanes) {
    const Lane gap = lesser(box_gap(f, sweep.R0.data(), sweep.t0.data()), box_gap(f, sweep.R1.data(), sweep.t1.data()));
    *reinterpret_cast<Lane*>(margins + i) = gap - load(f, kBoxReach) * sweep.bulge - (sweep.bulge_offset + sweep.error);
  }
}

TEGOTAE_WIDE void triangle_margins(const LaneBlocks& pairs, std::size_t count, const LaneSweep& sweep, float* margins) {
  const float* f = pairs.data();
  for (std::size_t i = 0; i < count; i += kLanes, f += kTriFields * kLanes) {
    const Lane gap =
        lesser(triangle_gap(f, sweep.R0.data(), sweep.t0.data()), triangle_gap(f, sweep.R1.data(), sweep.t1.data()));
    *reinterpret_cast<Lane*>(margins + i) = gap - load(f, kTriReach) * sweep.bulge - (sweep.bulge_offset + sweep.error);
  }
}

}  // namespace tegotae
