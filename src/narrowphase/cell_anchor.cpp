#include "narrowphase/cell_anchor.hpp"

#include <algorithm>
#include <limits>

#include "narrowphase/wide.hpp"

namespace tegotae {
namespace {

/// Gaps and what they lose are in single precision: of a gap, rounded down, and of three products and their sum.
constexpr double kGapSlack = 1 - 1e-6, kLossSlack = 1e-6;
/// Differences of positions in double precision are right up to this (m).
constexpr double kLengthSlack = 1e-11;

constexpr int kLane = 8;
typedef float Lane __attribute__((vector_size(kLane * sizeof(float)), may_alias));

TEGOTAE_INLINE Lane load(const std::array<float, kCellPlanes>& field, int first) {
  Lane lane;
  __builtin_memcpy(&lane, field.data() + first, sizeof(lane));
  return lane;
}

/// Least gaps after the piece has come by `one` and by `two` (B's axes, m).
struct Two {
  float one, two;
};
TEGOTAE_WIDE void least_gaps(const FreeCell& cell, const CellAnchor& anchor, const std::array<float, 3>& one,
                             const std::array<float, 3>& two, Two& out) {
  Lane first, second;
  for (int i = 0; i < kCellPlanes; i += kLane) {
    const Lane x = load(cell.nx, i), y = load(cell.ny, i), z = load(cell.nz, i), gap = load(anchor.gap, i);
    const Lane a = gap + (x * one[0] + y * one[1] + z * one[2]), b = gap + (x * two[0] + y * two[1] + z * two[2]);
    first = i == 0 || a < first ? a : first;
    second = i == 0 || b < second ? b : second;
  }
  out = {first[0], second[0]};
  for (int k = 1; k < kLane; ++k) {
    out.one = first[k] < out.one ? first[k] : out.one;
    out.two = second[k] < out.two ? second[k] : out.two;
  }
}

std::array<float, 3> floats(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

Vec3 vec(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

CellAnchor::CellAnchor() : x{}, turn(0), point{}, radius(0) {
  gap.fill(-std::numeric_limits<float>::infinity());
}

CellAnchor::CellAnchor(const CellGaps& gaps, const Vec3& middle, double radius_of, const Sweep& sweep, double turned)
    : turn(turned), point{middle.x(), middle.y(), middle.z()}, radius(kUnitSlack * radius_of) {
  const Vec3 at = sweep.start.R * middle + sweep.start.t;
  x = {at.x(), at.y(), at.z()};
  for (std::size_t k = 0; k < gaps.size(); ++k) gap[k] = static_cast<float>(kGapSlack * gaps[k]);
}

CellCorridor::CellCorridor(const Vec3& middle, double radius_of, const Vec3& shift, const Sweep& sweep, double turned)
    : turn(turned), radius(kUnitSlack * radius_of) {
  const Vec3 at = sweep.start.R * middle + sweep.start.t;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    x[i] = at[k];
    ahead[i] = shift[k];
    point[i] = middle[k];
  }
}

CorridorLoss corridor_loss(const CellCorridor& corridor, const Sweep& sweep, double turned) noexcept {
  const Vec3 point = vec(corridor.point), x = vec(corridor.x), ahead = vec(corridor.ahead);
  const double length2 = ahead.squaredNorm();
  const auto off = [&](const Placement& at) {
    const Vec3 moved = at.R * point + at.t - x;
    const double way = length2 > 0 ? std::clamp(moved.dot(ahead) / length2, 0.0, 1.0) : 0;
    return kUnitSlack * (moved - way * ahead).norm() + kLengthSlack;
  };
  const double turn = turned - corridor.turn, bulge = 0.125 * kUnitSlack * sweep.theta2;
  return {off(sweep.start) + corridor.radius * turn,
          off(sweep.end) + corridor.radius * (turn + kUnitSlack * sweep.theta),
          bulge * (point.norm() + corridor.radius + sweep.center_distance)};
}

AnchoredGap anchored_gap(const FreeCell& cell, const CellAnchor& anchor, const Sweep& sweep, double turned) noexcept {
  const Vec3 point = vec(anchor.point), x = vec(anchor.x);
  const Vec3 start = sweep.start.R * point + sweep.start.t - x, end = sweep.end.R * point + sweep.end.t - x;
  Two gaps;
  least_gaps(cell, anchor, floats(start), floats(end), gaps);
  // Points of the piece turn about `point` by as much at most.
  const double radius = anchor.radius, turn = turned - anchor.turn;
  const double bulge = 0.125 * kUnitSlack * sweep.theta2;
  return {gaps.one - kLossSlack * start.norm() - radius * turn,
          gaps.two - kLossSlack * end.norm() - radius * (turn + kUnitSlack * sweep.theta),
          bulge * (point.norm() + radius + sweep.center_distance)};
}

}  // namespace tegotae
