#include <limits>

#include "narrowphase/free_cell.hpp"
#include "narrowphase/wide.hpp"

namespace tegotae {
namespace {

typedef float Lane __attribute__((vector_size(kCellPlanes * sizeof(float)), may_alias));
typedef double FineLane __attribute__((vector_size(kCellPlanes * sizeof(double)), may_alias));
typedef std::int64_t FineBits __attribute__((vector_size(kCellPlanes * sizeof(double)), may_alias));

struct Normals {
  FineLane x, y, z;
};

TEGOTAE_INLINE FineLane load(const std::array<float, kCellPlanes>& field) {
  Lane lane;
  __builtin_memcpy(&lane, field.data(), sizeof(lane));
  return __builtin_convertvector(lane, FineLane);
}
TEGOTAE_INLINE FineLane along(const Normals& n, const Vec3& v) {
  return n.x * v.x() + n.y * v.y() + n.z * v.z();
}
TEGOTAE_INLINE FineLane magnitude(FineLane x) {
  return (FineLane)((FineBits)x & 0x7fffffffffffffff);
}
TEGOTAE_INLINE FineLane lesser(FineLane a, FineLane b) {
  return a < b ? a : b;
}
/// Of a hull, along all normals.
TEGOTAE_INLINE FineLane lowest(const Normals& n, const Hull& a) {
  if (a.is_triangle()) return lesser(lesser(along(n, a.corner(0)), along(n, a.corner(1))), along(n, a.corner(2)));
  return along(n, a.middle()) - a.half(0) * magnitude(along(n, a.axis(0))) -
         a.half(1) * magnitude(along(n, a.axis(1))) - a.half(2) * magnitude(along(n, a.axis(2)));
}
TEGOTAE_INLINE double least(FineLane x) {
  double out = x[0];
  for (int k = 1; k < kCellPlanes; ++k) out = x[k] < out ? x[k] : out;
  return out;
}

/// Gaps to all planes at the two ends of the motion.
struct Gaps {
  double least_start, least_end;
  CellGaps start, end;
};

TEGOTAE_WIDE void measure(const FreeCell& cell, const MovingHull& a, Gaps& out) {
  const Normals n{load(cell.nx), load(cell.ny), load(cell.nz)};
  const FineLane offset = load(cell.offset);
  const FineLane start = lowest(n, a.start) - offset, end = lowest(n, a.end) - offset;
  out.least_start = least(start);
  out.least_end = least(end);
  __builtin_memcpy(out.start.data(), &start, sizeof(start));
  __builtin_memcpy(out.end.data(), &end, sizeof(end));
}

}  // namespace

CellVerdict check_cell(const FreeCell& cell, const MovingHull& a, const Sweep& sweep) noexcept {
  Gaps gaps;
  measure(cell, a, gaps);
  CellVerdict out{true, gaps.least_start, 1, gaps.start};
  const double most = 0.125 * kUnitSlack * sweep.theta2 * (a.reach + sweep.center_distance);
  if (gaps.least_start - sweep.start_floor >= most && gaps.least_end - sweep.floor >= most) return out;
  for (int k = 0; k < kCellPlanes; ++k) {
    const double alpha = gaps.start[k] - sweep.start_floor, beta = gaps.end[k] - sweep.floor;
    const double b = bulge_along(cell.normal(k), a.reach, sweep);
    if (stays_positive(alpha, beta, b)) continue;
    out.free = false;
    out.share = std::min(out.share, alpha > 0 ? share_of(alpha, beta, b) : 0.0);
  }
  return out;
}

}  // namespace tegotae
