#pragma once

#include "lp/friction_solver.hpp"
#include "lp/least_distance.hpp"
#include "tegotae/coupling/contact_planes.hpp"
#include "tegotae/coupling/coupling.hpp"

namespace tegotae {

/// Brings the proxy up to date with a pen that has moved since the contact loop's last tick, by the law of the contact
/// loop's `qp`: X goes where the coupling's springs store least energy among the poses that the contact planes of that
/// tick allow. So for these planes the wrench is the gradient of an energy of the pen's pose, and changes by at most
/// the springs' stiffness times what the pen moves. Where planes have friction, Coulomb's law says where X goes, as it
/// does in the contact loop, or the part would creep between two ticks. Allocates only when it is made.
class LocalModel {
 public:
  LocalModel();

  /// `radius`: coupling_radius(), m. False and `x` untouched when there are no planes, when they were taken at another
  /// pose than `x.X`, the numbers make no sense, the pen has turned too far since the tick, or the part would have to
  /// turn too far for flat planes.
  bool update(const ContactPlanes& planes, double radius, const Vec3& center, const Pose& Y, const Twist& Y_velocity,
              ProxyState& x) noexcept;

 private:
  bool set_rows(const ContactPlanes& planes, const Vec3& center_W) noexcept;
  /// The displacement of the part for the `target`, whitened, with the contacts that carry in carrying_; false when
  /// there is none.
  bool solve(const Vec6& target, Vec6& z) noexcept;
  /// Displacement of the part from `X` that brings it nearest to `Y`, whitened; false when there is none.
  bool nearest(const Pose& X, const Vec3& center, const Pose& Y, Vec6& z) noexcept;
  /// What the contacts that carry leave of the pen's velocity, whitened; false when the program stalls.
  bool slide(const Vec6& pen, Vec6& velocity) noexcept;
  Vec6 whiten(const Displacement& d) const noexcept;
  Displacement unwhiten(const Vec6& z) const noexcept { return {z.head<3>(), z.tail<3>() / radius_}; }

  /// A contact that carries force.
  struct Carrying {
    int plane;
    bool sticks;
  };
  /// Rows of a plane that carries: its normal, or normal and both tangents to and fro where it sticks.
  static constexpr int kMaxActive = 6 * ContactPlanes::kMax;

  LeastDistanceSolver solver_;
  FrictionSolver friction_;
  LowRankMatrix rows_, active_rows_;
  double bounds_[ContactPlanes::kMax] = {};
  TangentRows tangents_[ContactPlanes::kMax];
  double mu_[ContactPlanes::kMax] = {};
  bool rubs_ = false;  ///< one of the planes has friction
  Carrying carrying_[SparseRows::kMax] = {};
  int carrying_count_ = 0;
  double radius_ = 1;
};

}  // namespace tegotae
