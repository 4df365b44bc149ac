#include "narrowphase/cell_anchor.hpp"

#include <limits>

#include "narrowphase/patch_lanes.hpp"
#include "narrowphase/wide.hpp"

namespace tegotae {
namespace {

/// Gaps and what they lose are in single precision: of a gap, rounded down, and of three products and their sum.
constexpr double kGapSlack = 1 - 1e-6, kLossSlack = 1e-6;

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

Vec3 vec(const std::array<float, 3>& v) {
  return {double{v[0]}, double{v[1]}, double{v[2]}};
}

}  // namespace

AnchoredMotion::AnchoredMotion(const Pose& X, const Displacement& d, const Vec3& center, double turned)
    : R_start(X.q.toRotationMatrix()),
      R_end(rotation(d.dr).toRotationMatrix() * R_start),
      p_start(X * center),
      p_end(p_start + d.dp),
      turn_start(turned),
      turn_end(turned + d.dr.norm()),
      bulge(0.125 * kUnitSlack * d.dr.squaredNorm()),
      center_distance(center.norm()) {}

CellAnchor::CellAnchor() : x{}, turn(0), point{}, radius(0) {
  gap.fill(-std::numeric_limits<float>::infinity());
}

CellAnchor::CellAnchor(const CellGaps& gaps, const Vec3& middle, double radius_of, const AnchoredMotion& motion)
    : turn(motion.turn_start),
      point(floats(middle)),
      radius(round_up<float>(radius_of + (middle - vec(point)).norm())) {
  const Vec3 at = motion.R_start * vec(point) + motion.p_start;
  x = {at.x(), at.y(), at.z()};
  for (std::size_t k = 0; k < gaps.size(); ++k) gap[k] = static_cast<float>(kGapSlack * gaps[k]);
}

AnchoredGap anchored_gap(const FreeCell& cell, const CellAnchor& anchor, const Mat3& R_WB,
                         const AnchoredMotion& motion) noexcept {
  const Vec3 point = vec(anchor.point), x(anchor.x[0], anchor.x[1], anchor.x[2]);
  const Vec3 start = R_WB.transpose() * (motion.R_start * point + motion.p_start - x);
  const Vec3 end = R_WB.transpose() * (motion.R_end * point + motion.p_end - x);
  Two gaps;
  least_gaps(cell, anchor, floats(start), floats(end), gaps);
  // Points of the piece turn about `point` by as much at most.
  const double radius = kUnitSlack * double{anchor.radius};
  return {gaps.one - kLossSlack * start.norm() - radius * (motion.turn_start - anchor.turn),
          gaps.two - kLossSlack * end.norm() - radius * (motion.turn_end - anchor.turn),
          motion.bulge * (point.norm() + radius + motion.center_distance)};
}

}  // namespace tegotae
