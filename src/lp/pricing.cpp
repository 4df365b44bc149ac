#include "lp/pricing.hpp"

#include <cmath>
#include <cstring>

#include "core/numbers.hpp"

// Each pass is written once for a vector of kBytes and compiled for three instruction sets. Every lane does the same
// IEEE operations (no fused ones: the build forbids contraction), so the width changes the speed and nothing else.
#define TEGOTAE_INLINE inline __attribute__((always_inline))

namespace tegotae {
namespace {

template <int kBytes>
struct Wide {
  typedef double D __attribute__((vector_size(kBytes)));  // GCC ignores a dependent size in an alias declaration
  static constexpr int kCount = kBytes / 8;
  static constexpr int kParts = kRowLanes / kCount;
};

template <int kBytes>
TEGOTAE_INLINE void load(typename Wide<kBytes>::D& to, const double* from) {
  std::memcpy(&to, from, kBytes);
}

/// sum = Σ_k g[k] x[k] for the rows at `lane`, always added in the same order.
template <int kBytes>
TEGOTAE_INLINE void dot(typename Wide<kBytes>::D& sum, const RowBlock& block, int lane, const double* x) {
  typename Wide<kBytes>::D g;
  load<kBytes>(sum, block.g[0] + lane);
  sum *= x[0];
  for (int k = 1; k < 6; ++k) {
    load<kBytes>(g, block.g[k] + lane);
    sum += g * x[k];
  }
}

/// The largest of `best`; among equals the lowest row. `at` holds row numbers.
TEGOTAE_INLINE RowChoice reduce(const double* best, const double* at, int lanes) {
  RowChoice choice;
  for (int i = 0; i < lanes; ++i) {
    const int row = static_cast<int>(at[i]);
    if (best[i] > choice.value || (best[i] == choice.value && choice.row >= 0 && row >= 0 && row < choice.row)) {
      choice = {row, best[i]};
    }
  }
  return choice;
}

TEGOTAE_INLINE void inverse_norms_of(const RowBlock* g, int blocks, LaneBlock* inverse_norm) {
  for (int b = 0; b < blocks; ++b) {
    for (int i = 0; i < kRowLanes; ++i) {
      double square = 0;
      for (int k = 0; k < 6; ++k) {
        square += g[b].g[k][i] * g[b].g[k][i];
      }
      inverse_norm[b].v[i] = 1 / std::sqrt(square);
    }
  }
}

/// Running maximum with the row it came from, lane by lane.
template <int kBytes>
struct Maximum {
  using W = Wide<kBytes>;
  typename W::D best[W::kParts];
  typename W::D at[W::kParts];
  typename W::D row[W::kParts];

  TEGOTAE_INLINE Maximum() {
    for (int p = 0; p < W::kParts; ++p) {
      for (int i = 0; i < W::kCount; ++i) {
        best[p][i] = 0;
        at[p][i] = -1;
        row[p][i] = p * W::kCount + i;
      }
    }
  }
  TEGOTAE_INLINE void take(int part, const typename W::D& value) {
    const auto better = value > best[part];
    best[part] = better ? value : best[part];
    at[part] = better ? row[part] : at[part];
    row[part] += double{kRowLanes};
  }
  TEGOTAE_INLINE RowChoice choice() const {
    double flat_best[kRowLanes], flat_at[kRowLanes];
    std::memcpy(flat_best, best, sizeof best);
    std::memcpy(flat_at, at, sizeof at);
    return reduce(flat_best, flat_at, kRowLanes);
  }
};

template <int kBytes>
TEGOTAE_INLINE RowChoice most_violated_of(const RowBlock* g, const LaneBlock* d, const LaneBlock* scale, int blocks,
                                          const double* w) {
  using W = Wide<kBytes>;
  Maximum<kBytes> maximum;
  for (int b = 0; b < blocks; ++b) {
    for (int p = 0; p < W::kParts; ++p) {
      const int lane = p * W::kCount;
      typename W::D sum, di, si;
      dot<kBytes>(sum, g[b], lane, w);
      load<kBytes>(di, d[b].v + lane);
      load<kBytes>(si, scale[b].v + lane);
      maximum.take(p, (di - sum) * si);
    }
  }
  return maximum.choice();
}

template <int kBytes>
TEGOTAE_INLINE double steps_of(const RowBlock* g, const LaneBlock* scale, int blocks, const double* u, const double* v,
                               double min_pivot, double slack, LaneBlock* step, LaneBlock* pivot) {
  using W = Wide<kBytes>;
  using D = typename W::D;
  const D zero = {};
  const D infinite = zero + kInfinity;
  D least = infinite;
  for (int b = 0; b < blocks; ++b) {
    for (int p = 0; p < W::kParts; ++p) {
      const int lane = p * W::kCount;
      D gu, gv, si;
      dot<kBytes>(gu, g[b], lane, u);
      dot<kBytes>(gv, g[b], lane, v);
      load<kBytes>(si, scale[b].v + lane);
      const D pivot_j = gv * si;
      const auto eligible = pivot_j > min_pivot;
      D reduced = 1.0 - gu;
      reduced = reduced > zero ? reduced : zero;
      const D step_j = eligible ? reduced / gv : infinite;
      const D bound_j = eligible ? (reduced + slack) / gv : infinite;
      least = bound_j < least ? bound_j : least;
      const D kept = eligible ? pivot_j : zero;
      std::memcpy(step[b].v + lane, &step_j, kBytes);
      std::memcpy(pivot[b].v + lane, &kept, kBytes);
    }
  }
  double bound = kInfinity;
  for (int i = 0; i < W::kCount; ++i) {
    bound = least[i] < bound ? least[i] : bound;
  }
  return bound;
}

template <int kBytes>
TEGOTAE_INLINE RowChoice largest_pivot_of(const LaneBlock* step, const LaneBlock* pivot, int blocks, double bound) {
  using W = Wide<kBytes>;
  const typename W::D zero = {};
  Maximum<kBytes> maximum;
  for (int b = 0; b < blocks; ++b) {
    for (int p = 0; p < W::kParts; ++p) {
      const int lane = p * W::kCount;
      typename W::D step_j, pivot_j;
      load<kBytes>(step_j, step[b].v + lane);
      load<kBytes>(pivot_j, pivot[b].v + lane);
      maximum.take(p, step_j <= bound ? pivot_j : zero);
    }
  }
  return maximum.choice();
}

template <int kBytes>
TEGOTAE_INLINE RowChoice most_violated_cone_of(const RowBlock* g, const RowBlock* t0, const RowBlock* t1,
                                               const LaneBlock* d, int blocks, const double* w, double least) {
  using W = Wide<kBytes>;
  using D = typename W::D;
  const D zero = {};
  RowChoice choice{-1, least};
  for (int b = 0; b < blocks; ++b) {
    double normal[kRowLanes], square[kRowLanes], beyond[kRowLanes];
    for (int p = 0; p < W::kParts; ++p) {
      const int lane = p * W::kCount;
      D n, s0, s1, di;
      dot<kBytes>(n, g[b], lane, w);
      dot<kBytes>(s0, t0[b], lane, w);
      dot<kBytes>(s1, t1[b], lane, w);
      load<kBytes>(di, d[b].v + lane);
      const D by = di - n, slip = s0 * s0 + s1 * s1, room = choice.value - by;
      const D over = slip - room * (room > zero ? room : -room);
      std::memcpy(normal + lane, &by, kBytes);
      std::memcpy(square + lane, &slip, kBytes);
      std::memcpy(beyond + lane, &over, kBytes);
    }
    // Few rows are worth a square root.
    for (int i = 0; i < kRowLanes; ++i) {
      if (!(beyond[i] > 0)) continue;
      const double by = normal[i] + std::sqrt(square[i]);
      if (by > choice.value) choice = {b * kRowLanes + i, by};
    }
  }
  return choice;
}

template <int kBytes>
TEGOTAE_INLINE void sum_products_of(const PaddedVec6* a, const PaddedVec6* b, int n, PaddedVec6* h) {
  using W = Wide<kBytes>;
  for (int p = 0; p < W::kParts; ++p) {
    const int lane = p * W::kCount;
    if (lane >= 6) break;
    typename W::D sum[6] = {}, column;
    for (int k = 0; k < n; ++k) {
      load<kBytes>(column, b[k].v + lane);
      for (int i = 0; i < 6; ++i) sum[i] += a[k].v[i] * column;
    }
    for (int i = 0; i < 6; ++i) std::memcpy(h[i].v + lane, &sum[i], kBytes);
  }
}

#define TEGOTAE_PRICING(name, isa, bytes)                                                                          \
  isa void inverse_norms_##name(const RowBlock* g, int blocks, LaneBlock* inverse_norm) {                          \
    inverse_norms_of(g, blocks, inverse_norm);                                                                     \
  }                                                                                                                \
  isa RowChoice most_violated_##name(const RowBlock* g, const LaneBlock* d, const LaneBlock* scale, int blocks,    \
                                     const double* w) {                                                            \
    return most_violated_of<bytes>(g, d, scale, blocks, w);                                                        \
  }                                                                                                                \
  isa double steps_##name(const RowBlock* g, const LaneBlock* scale, int blocks, const double* u, const double* v, \
                          double min_pivot, double slack, LaneBlock* step, LaneBlock* pivot) {                     \
    return steps_of<bytes>(g, scale, blocks, u, v, min_pivot, slack, step, pivot);                                 \
  }                                                                                                                \
  isa RowChoice largest_pivot_##name(const LaneBlock* step, const LaneBlock* pivot, int blocks, double bound) {    \
    return largest_pivot_of<bytes>(step, pivot, blocks, bound);                                                    \
  }                                                                                                                \
  isa RowChoice most_violated_cone_##name(const RowBlock* g, const RowBlock* t0, const RowBlock* t1,               \
                                          const LaneBlock* d, int blocks, const double* w, double least) {         \
    return most_violated_cone_of<bytes>(g, t0, t1, d, blocks, w, least);                                           \
  }                                                                                                                \
  isa void sum_products_##name(const PaddedVec6* a, const PaddedVec6* b, int n, PaddedVec6* h) {                   \
    sum_products_of<bytes>(a, b, n, h);                                                                            \
  }                                                                                                                \
  constexpr Pricing kPricing_##name = {inverse_norms_##name, most_violated_##name,      steps_##name,              \
                                       largest_pivot_##name, most_violated_cone_##name, sum_products_##name};

TEGOTAE_PRICING(baseline, , 16)
#ifdef __x86_64__
TEGOTAE_PRICING(avx2, __attribute__((target("avx2"))), 32)
TEGOTAE_PRICING(avx512, __attribute__((target("avx512f"))), 64)
#endif

}  // namespace

const Pricing* pricing(InstructionSet set) noexcept {
#ifdef __x86_64__
  if (set == InstructionSet::avx512) {
    return __builtin_cpu_supports("avx512f") ? &kPricing_avx512 : nullptr;
  }
  if (set == InstructionSet::avx2) {
    return __builtin_cpu_supports("avx2") ? &kPricing_avx2 : nullptr;
  }
#endif
  return set == InstructionSet::baseline ? &kPricing_baseline : nullptr;
}

const Pricing& pricing() noexcept {
  for (const InstructionSet set : {InstructionSet::avx512, InstructionSet::avx2}) {
    if (const Pricing* wide = pricing(set)) {
      return *wide;
    }
  }
  return kPricing_baseline;
}

}  // namespace tegotae
