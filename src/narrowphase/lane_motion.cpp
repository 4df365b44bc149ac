#include "narrowphase/lane_motion.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace tegotae {
namespace {

/// Rounding of one gap in single precision: 32 units in the last place of the largest terms (about 20 from turning the
/// normal and the products, 7 from the sums).
constexpr double kLaneError = 1.0 / (1 << 19);
/// The same in double precision: what the stored single-precision offset, center and edges are rounded by (half a unit
/// in the last place each; doubled).
constexpr double kFineError = 1.0 / (1 << 23);
/// Bulges are rounded up by this.
constexpr double kBulgeSlack = 1.00001;

/// Numbers that are no zero but too small to be normal ones in single precision (below 1.2e-38) slow a processor down
/// tenfold, and a bulge of no turn at all, rounded up, is the smallest of them. These are far below any rounding.
constexpr double kTiny = 1e-30;
double without_tiny(double x) {
  return std::abs(x) < kTiny ? 0 : x;
}

/// `terms` bounds those of a gap, m.
LaneSweep lane_sweep(const Placement& start, const Placement& end, double bulge, double bulge_offset, double terms,
                     double floor) {
  LaneSweep s;
  const auto fill = [&](auto& m) {
    using Real = std::decay_t<decltype(m.bulge)>;
    for (int i = 0; i < 3; ++i) {
      m.t0[i] = static_cast<Real>(without_tiny(start.t[i]));
      m.t1[i] = static_cast<Real>(without_tiny(end.t[i]));
      for (int j = 0; j < 3; ++j) {
        m.R0[3 * i + j] = static_cast<Real>(without_tiny(start.R(i, j)));
        m.R1[3 * i + j] = static_cast<Real>(without_tiny(end.R(i, j)));
      }
    }
    m.bulge = round_up<Real>(std::max(kTiny, kBulgeSlack * bulge));
    m.bulge_offset = round_up<Real>(std::max(kTiny, kBulgeSlack * bulge_offset));
  };
  fill(s.coarse);
  fill(s.fine);
  s.coarse.error = round_up<float>(kLaneError * terms + floor);
  s.fine.error = kFineError * terms + floor;
  return s;
}

double farthest(const Sweep& sweep) {
  return std::max(sweep.start.t.norm(), sweep.end.t.norm());
}

Placement inverse(const Placement& p) {
  return {p.R.transpose(), -(p.R.transpose() * p.t)};
}

}  // namespace

LaneSweep seen_from_b(const Sweep& sweep, const PairSizes& sizes) {
  const double bulge = sweep.theta2 / 8;
  return lane_sweep(sweep.start, sweep.end, bulge, bulge * sweep.center_distance,
                    farthest(sweep) + 3 * sizes.reach_a + 2 * sizes.radius_b, sweep.floor);
}

LaneSweep seen_from_a(const Sweep& sweep, const PairSizes& sizes) {
  // y = Rᵀ(b − t) has |y''| ≤ θ²(|b| + |t|) + 2θ|dp|.
  const double bulge = sweep.theta2 / 8, coriolis = sweep.theta * sweep.dp.norm() / 4;
  return lane_sweep(inverse(sweep.start), inverse(sweep.end), bulge,
                    bulge * (farthest(sweep) + sweep.center_distance) + coriolis,
                    farthest(sweep) + 3 * sizes.reach_b + 2 * sizes.radius_a, sweep.floor);
}

}  // namespace tegotae
