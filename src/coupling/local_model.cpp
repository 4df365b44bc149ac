#include "coupling/local_model.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace tegotae {

namespace {

// A pen turned farther from the part (rad) is past what flat limits tell about rotations.
constexpr double kMostTurn = 0.5;
// Normals may be off unit length by so much.
constexpr double kUnitTolerance = 1e-6;

}  // namespace

LocalModel::LocalModel()
    : solver_(ContactPlanes::kMost), rows_(ContactPlanes::kMost), active_rows_(ContactPlanes::kMost) {}

bool LocalModel::set_metric(const Mat3& gyration, const Quat& R_X) noexcept {
  if (!gyration.allFinite()) return false;
  const Eigen::LLT<Mat3> cholesky(gyration);
  if (cholesky.info() != Eigen::Success) return false;
  const Mat3 L = cholesky.matrixL();
  if (!(L.diagonal().minCoeff() > 0)) return false;
  const Mat3 R = R_X.toRotationMatrix();
  to_whitened_ = L.transpose() * R.transpose();
  to_rotation_ = to_whitened_.inverse();
  return to_rotation_.allFinite();
}

Vec6 LocalModel::whiten(const Vec3& dp, const Vec3& dr) const noexcept {
  Vec6 z;
  z << dp, to_whitened_ * dr;
  return z;
}

bool LocalModel::set_rows(const ContactPlanes& planes, const Vec3& center_W) noexcept {
  rows_.clear();
  for (int i = 0; i < planes.count; ++i) {
    const ContactPlane& plane = planes.planes[static_cast<std::size_t>(i)];
    if (!(std::abs(plane.normal.squaredNorm() - 1) < kUnitTolerance)) return false;
    Vec6 row;
    row << plane.normal, to_rotation_.transpose() * (plane.point - center_W).cross(plane.normal);
    rows_.push_row(row);
    bounds_[i] = -plane.room;
  }
  return true;
}

bool LocalModel::update(const ContactPlanes& planes, const Mat3& gyration, const Vec3& center, const Pose& Y,
                        const Twist& Y_velocity, ProxyState& x) noexcept {
  if (planes.count <= 0 || planes.count > ContactPlanes::kMost || !planes.taken_at(x.X)) return false;
  const Displacement before = displacement(x.X, planes.pen, center);
  const Displacement now = displacement(x.X, Y, center);
  if (!(before.dr.norm() < kMostTurn && now.dr.norm() < kMostTurn)) return false;
  if (!set_metric(gyration, x.X.q) || !set_rows(planes, x.X * center)) return false;
  const QpResult& then = solver_.solve(rows_, bounds_, whiten(before.dp, before.dr));
  if (then.status != LpStatus::optimal) return false;
  const Vec6 z_before = then.z;
  const QpResult& fresh = solver_.solve(rows_, bounds_, whiten(now.dp, now.dr));
  if (fresh.status != LpStatus::optimal) return false;
  const Vec6 step = fresh.z - z_before;
  // The velocity that the planes in use leave of the pen's.
  active_rows_.clear();
  for (int i = 0; i < fresh.multipliers.count; ++i)
    active_rows_.push_row(rows_.row(fresh.multipliers.index[static_cast<std::size_t>(i)]));
  const bool touching = fresh.multipliers.count > 0;
  const double zeros[ContactPlanes::kMost] = {};
  const QpResult& slide = solver_.solve(active_rows_, zeros, whiten(Y_velocity.v, Y_velocity.w));
  if (slide.status != LpStatus::optimal) return false;
  x.velocity = {slide.z.head<3>(), to_rotation_ * slide.z.tail<3>()};
  x.X = displaced(x.X, center, {step.head<3>(), to_rotation_ * step.tail<3>()});
  x.touching |= touching;
  return true;
}

}  // namespace tegotae
