#include "curve/axis_motion.hpp"

#include <algorithm>
#include <cmath>

#include "core/numbers.hpp"

namespace tegotae {
namespace {

/// Axes that lean more against each other are not looked at; nor are larger turns (rad), which the proof excludes.
constexpr double kMaxLean = 0.2, kMaxTurn = 0.5;
/// Rounding of one gap, relative to the largest terms: some 100 operations of 1.1e-16.
constexpr double kMotionRounding = 5e-14;

/// What one reading of the path adds: `p0` to `p1` is the way of the point that moves linearly.
void add_reading(const Vec3& p0, const Vec3& p1, const Vec3& turn, double reach, AxisMotion& m) {
  const Vec3 dp = p1 - p0;
  const double turn_h = turn.head<2>().norm(), turn_z = std::abs(turn.z());
  // The velocity of A's points beyond a turn about B's axis: linear in time, largest at an end.
  const auto beyond = [&](const Vec3& p) {
    return std::hypot(dp.x() + turn.z() * p.y(), dp.y() - turn.z() * p.x()) + reach * turn_h;
  };
  const double speed = std::max(beyond(p0), beyond(p1));
  m.speed = std::max(m.speed, speed);
  m.acceleration = std::max(m.acceleration, turn_z * (speed + dp.head<2>().norm()) + turn_h * turn_h * reach);
  m.vertical = std::max(m.vertical, turn_h * turn.norm() * reach);
}

}  // namespace

AxisPose AxisPose::of(const Mat3& R, const Vec3& t, double rise, double near_psi) {
  AxisPose p;
  p.offset_x = t.x();
  p.offset_y = t.y();
  p.lean_x = R(0, 2);
  p.lean_y = R(1, 2);
  p.lean = std::hypot(p.lean_x, p.lean_y);
  const double up = 1 + R(2, 2);
  p.lean2 = p.lean * p.lean / up;
  // A's x axis with the tilt taken back: Tilt^T x, of which only the horizontal part is left.
  const Vec3 x = R.col(0);
  const double along = (p.lean_x * x.x() + p.lean_y * x.y()) / up + x.z();
  const double c = x.x() - p.lean_x * along, s = x.y() - p.lean_y * along;
  const double length = std::hypot(c, s);
  p.cos_psi = length > 0 ? c / length : 1;
  p.sin_psi = length > 0 ? s / length : 0;
  const double psi = std::atan2(p.sin_psi, p.cos_psi);
  p.psi = psi + 2 * kPi * std::round((near_psi - psi) / (2 * kPi));
  p.shift = t.z() - rise * p.psi;
  return p;
}

AxisMotion axis_motion(const FrameMotion& f, double rise, double start_floor, double floor, double near_psi) {
  AxisMotion m;
  m.rise = rise;
  m.start = AxisPose::of(f.R0, f.t0, rise, near_psi);
  m.end = AxisPose::of(f.R1, f.t1, rise, m.start.psi);
  m.usable = f.R0(2, 2) > 0 && f.R1(2, 2) > 0 && m.start.lean < kMaxLean && m.end.lean < kMaxLean &&
             f.turn.norm() < kMaxTurn &&
             std::isfinite(f.size + f.t0.squaredNorm() + f.t1.squaredNorm() + f.center0.squaredNorm() +
                           f.center1.squaredNorm() + f.origin0.squaredNorm() + f.origin1.squaredNorm());
  add_reading(f.center0, f.center1, f.turn, f.reach_center, m);
  add_reading(f.origin0, f.origin1, f.turn, f.reach_origin, m);
  const double terms = f.size + std::abs(rise) * (2 * kPi + std::abs(m.start.psi));
  m.start_floor = start_floor + kMotionRounding * terms;
  m.floor = floor + kMotionRounding * terms;
  return m;
}

}  // namespace tegotae
