#pragma once

#include "lp/least_distance.hpp"
#include "tegotae/coupling/contact_planes.hpp"
#include "tegotae/coupling/coupling.hpp"

namespace tegotae {

/// Brings the proxy up to date with a pen that has moved since the contact loop's last tick: the pen's way is projected
/// on the contact planes of that tick, in the mass metric that the contact loop uses. At the pen pose which that tick
/// answered, the proxy is the contact loop's own. Allocates only when it is made.
class LocalModel {
 public:
  LocalModel();

  /// `gyration`: inertia over mass of the held part about its center, file frame, m². False and `x` untouched when
  /// there are no planes, they were taken at another pose than `x.X`, the numbers make no sense, or the pen has turned
  /// too far for flat limits.
  bool update(const ContactPlanes& planes, const Mat3& gyration, const Vec3& center, const Pose& Y,
              const Twist& Y_velocity, ProxyState& x) noexcept;

 private:
  /// Makes whitened coordinates (dp, Lᵀ R_Xᵀ dr) with L Lᵀ = gyration, in which the mass metric is the length.
  bool set_metric(const Mat3& gyration, const Quat& R_X) noexcept;
  Vec6 whiten(const Vec3& dp, const Vec3& dr) const noexcept;
  bool set_rows(const ContactPlanes& planes, const Vec3& center_W) noexcept;

  LeastDistanceSolver solver_;
  LowRankMatrix rows_, active_rows_;
  double bounds_[ContactPlanes::kMost] = {};
  Mat3 to_whitened_ = Mat3::Identity();  ///< of a rotation vector in the world
  Mat3 to_rotation_ = Mat3::Identity();  ///< its inverse
};

}  // namespace tegotae
