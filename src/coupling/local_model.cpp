#include "coupling/local_model.hpp"

#include <cmath>

namespace tegotae {

namespace {

// A part turned by more than this (rad) is past what flat planes tell about rotations; so is a pen that turned so much
// since they were taken.
constexpr double kMostTurn = 0.5;
// From here on (rad) the shortest way from part to pen may turn round.
constexpr double kMostError = 3.0;
// Normals may be off unit length by so much.
constexpr double kUnitTolerance = 1e-6;
// A target that changes by no more than this (m) is left as it is: a force of 1 nN.
constexpr double kSettled = 1e-12;
// Each round leaves about a twelfth of the squared turn (rad²) of the last one's change, so a few are enough.
constexpr int kMostRounds = 8;

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
    : solver_(ContactPlanes::kMost), rows_(ContactPlanes::kMost), active_rows_(ContactPlanes::kMost) {}

Vec6 LocalModel::whiten(const Displacement& d) const noexcept {
  Vec6 z;
  z << d.dp, radius_ * d.dr;
  return z;
}

bool LocalModel::set_rows(const ContactPlanes& planes, const Vec3& center_W) noexcept {
  rows_.clear();
  for (int i = 0; i < planes.count; ++i) {
    const ContactPlane& plane = planes.planes[static_cast<std::size_t>(i)];
    if (!(std::abs(plane.normal.squaredNorm() - 1) < kUnitTolerance)) return false;
    Vec6 row;
    row << plane.normal, (plane.point - center_W).cross(plane.normal) / radius_;
    rows_.push_row(row);
    bounds_[i] = -plane.room;
  }
  return true;
}

const QpResult* LocalModel::nearest(const Pose& X, const Vec3& center, const Pose& Y) noexcept {
  // Where the part turns, the way to the pen is not the difference of two rotation vectors. So what is left of it at
  // each answer, carried back to X, is the next target; it settles where the energy is least.
  Vec6 target = whiten(displacement(X, Y, center));
  for (int round = 0; round < kMostRounds; ++round) {
    const QpResult& r = solver_.solve(rows_, bounds_, target);
    if (r.status != LpStatus::optimal) return nullptr;
    const Displacement made = unwhiten(r.z);
    if (!(made.dr.norm() < kMostTurn)) return nullptr;
    Displacement left = displacement(displaced(X, center, made), Y, center);
    left.dr = left_jacobian(made.dr).transpose() * left.dr;
    const Vec6 next = r.z + whiten(left);
    if ((next - target).norm() <= kSettled) return &r;
    target = next;
  }
  const QpResult& r = solver_.solve(rows_, bounds_, target);
  return r.status == LpStatus::optimal ? &r : nullptr;
}

bool LocalModel::update(const ContactPlanes& planes, double radius, const Vec3& center, const Pose& Y,
                        const Twist& Y_velocity, ProxyState& x) noexcept {
  if (planes.count <= 0 || planes.count > ContactPlanes::kMost || !(radius > 0) || !planes.taken_at(x.X)) return false;
  const double since = displacement(planes.pen, Y, center).dr.norm();
  const double error = displacement(x.X, Y, center).dr.norm();
  if (!(since < kMostTurn && error < kMostError)) return false;
  radius_ = radius;
  if (!set_rows(planes, x.X * center)) return false;
  const QpResult* fresh = nearest(x.X, center, Y);
  if (!fresh) return false;
  const Displacement step = unwhiten(fresh->z);
  // The velocity that the planes in use leave of the pen's.
  active_rows_.clear();
  for (int i = 0; i < fresh->multipliers.count; ++i)
    active_rows_.push_row(rows_.row(fresh->multipliers.index[static_cast<std::size_t>(i)]));
  const bool touching = fresh->multipliers.count > 0;
  const double zeros[ContactPlanes::kMost] = {};
  const QpResult& slide = solver_.solve(active_rows_, zeros, whiten({Y_velocity.v, Y_velocity.w}));
  if (slide.status != LpStatus::optimal) return false;
  const Displacement left = unwhiten(slide.z);
  x.velocity = {left.dp, left.dr};
  x.X = displaced(x.X, center, step);
  x.touching |= touching;
  return true;
}

}  // namespace tegotae
