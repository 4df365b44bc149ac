#include "coupling/local_model.hpp"

#include <algorithm>
#include <cmath>

#include "lp/tangents.hpp"

namespace tegotae {

namespace {

// A part turned by more than this (rad) is past what flat planes tell about rotations; so is a pen that turned so much
// since they were taken.
constexpr double kMaxTurn = 0.5;
// From here on (rad) the shortest way from part to pen may turn round.
constexpr double kMaxError = 3.0;
// Normals may be off unit length by so much.
constexpr double kUnitTolerance = 1e-6;
// A target that changes by no more than this (m) is left as it is: a force of 1 nN.
constexpr double kSettled = 1e-12;
// With friction, by this part of the target: so well is the program solved.
constexpr double kSettledRubbing = 1e-8;
// No pair of surfaces has more friction.
constexpr double kMaxMu = 10;
// Each round leaves about a twelfth of the squared turn (rad²) of the last one's change, so a few are enough.
constexpr int kMaxRounds = 8;

Mat3 cross_matrix(const Vec3& v) {
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// J of rotation(r + δ) ≈ rotation(J δ) rotation(r) for small δ.
Mat3 left_jacobian(const Vec3& r) {
  const double angle2 = r.squaredNorm();
  const Mat3 K = cross_matrix(r);
  if (angle2 < 1e-8) return Mat3::Identity() + 0.5 * K;
  const double angle = std::sqrt(angle2);
  return Mat3::Identity() + (1 - std::cos(angle)) / angle2 * K + (angle - std::sin(angle)) / (angle2 * angle) * K * K;
}

}  // namespace

LocalModel::LocalModel()
    : solver_(kMaxActive), friction_(ContactPlanes::kMax), rows_(ContactPlanes::kMax), active_rows_(kMaxActive) {}

Vec6 LocalModel::whiten(const Displacement& d) const noexcept {
  Vec6 z;
  z << d.dp, radius_ * d.dr;
  return z;
}

bool LocalModel::set_rows(const ContactPlanes& planes, const Vec3& center_W) noexcept {
  rows_.clear();
  rubs_ = false;
  for (int i = 0; i < planes.count; ++i) {
    const ContactPlane& plane = planes.planes[static_cast<std::size_t>(i)];
    if (!(std::abs(plane.normal.squaredNorm() - 1) < kUnitTolerance)) return false;
    if (!(plane.mu >= 0 && plane.mu <= kMaxMu)) return false;
    const auto along = [&](const Vec3& e) {
      Vec6 row;
      row << e, (plane.point - center_W).cross(e) / radius_;
      return row;
    };
    rows_.push_row(along(plane.normal));
    bounds_[i] = -plane.clearance;
    mu_[i] = plane.mu;
    if (!(plane.mu > 0)) continue;
    rubs_ = true;
    const Tangents tangents(plane.normal);
    for (int k = 0; k < 2; ++k) tangents_[i].row[k] = along(tangents.direction[k]);
  }
  return true;
}

bool LocalModel::solve(const Vec6& target, Vec6& z) noexcept {
  carrying_count_ = 0;
  if (rubs_) {
    const FrictionResult& r = friction_.solve({rows_, bounds_, tangents_, mu_, target});
    z = r.z;
    for (const FrictionForce& f : r.forces) carrying_[carrying_count_++] = {f.row, mu_[f.row] > 0 && !f.slides};
    return r.status == LpStatus::optimal;
  }
  const QpResult& r = solver_.solve(rows_, bounds_, target);
  z = r.z;
  for (int i = 0; i < r.multipliers.count; ++i)
    carrying_[carrying_count_++] = {r.multipliers.index[static_cast<std::size_t>(i)], false};
  return r.status == LpStatus::optimal;
}

bool LocalModel::nearest(const Pose& X, const Vec3& center, const Pose& Y, Vec6& z) noexcept {
  // Where the part turns, the way to the pen is not the difference of two rotation vectors. So what is left of it at
  // each answer, carried back to X, is the next target; it settles where the energy is least.
  Vec6 target = whiten(displacement(X, Y, center));
  const double settled = rubs_ ? std::max(kSettled, kSettledRubbing * target.norm()) : kSettled;
  for (int round = 0; round < kMaxRounds; ++round) {
    if (!solve(target, z)) return false;
    const Displacement made = unwhiten(z);
    if (!(made.dr.norm() < kMaxTurn)) return false;
    Displacement left = displacement(displaced(X, center, made), Y, center);
    left.dr = left_jacobian(made.dr).transpose() * left.dr;
    const Vec6 next = z + whiten(left);
    if ((next - target).norm() <= settled) return true;
    target = next;
  }
  return solve(target, z);
}

bool LocalModel::slide(const Vec6& pen, Vec6& velocity) noexcept {
  active_rows_.clear();
  for (int i = 0; i < carrying_count_; ++i) {
    const Vec6 n = rows_.row(carrying_[i].plane);
    active_rows_.push_row(n);
    if (!carrying_[i].sticks) continue;
    // Its point stands still; it does not lift either while it is pressed down.
    active_rows_.push_row(-n);
    for (const Vec6& t : tangents_[carrying_[i].plane].row) {
      active_rows_.push_row(t);
      active_rows_.push_row(-t);
    }
  }
  const double zeros[kMaxActive] = {};
  const QpResult& r = solver_.solve(active_rows_, zeros, pen);
  velocity = r.z;
  return r.status == LpStatus::optimal;
}

bool LocalModel::update(const ContactPlanes& planes, double radius, const Vec3& center, const Pose& Y,
                        const Twist& Y_velocity, ProxyState& x) noexcept {
  if (planes.count <= 0 || planes.count > ContactPlanes::kMax || !(radius > 0) || !planes.taken_at(x.X)) return false;
  const double since = displacement(planes.pen, Y, center).dr.norm();
  const double error = displacement(x.X, Y, center).dr.norm();
  if (!(since < kMaxTurn && error < kMaxError)) return false;
  radius_ = radius;
  if (!set_rows(planes, x.X * center)) return false;
  Vec6 step;
  if (!nearest(x.X, center, Y, step)) return false;
  const bool touching = carrying_count_ > 0;
  // The velocity that the planes in use leave of the pen's.
  Vec6 slides;
  if (!slide(whiten({Y_velocity.v, Y_velocity.w}), slides)) return false;
  const Displacement left = unwhiten(slides);
  x.velocity = {left.dp, left.dr};
  x.X = displaced(x.X, center, unwhiten(step));
  x.touching |= touching;
  return true;
}

}  // namespace tegotae
