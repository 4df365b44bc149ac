#pragma once

#include <memory>
#include <vector>

#include "broadphase/bounding_spheres.hpp"
#include "feature/vertex_shell.hpp"
#include "loop/initial_contacts.hpp"
#include "loop/proxy_loop.hpp"

namespace tegotae {

/// The penalty method as a baseline of the programs: every vertex inside the other part pushes back in proportion to
/// its depth (the point shell of McNeely, Puterbaugh and Troy, "Six degree-of-freedom haptic rendering using voxel
/// sampling", 1999). The held part hangs on the pen by the coupling and is where coupling and penalty forces balance
/// (the quasi-static virtual tool of Wan and McNeely, "Quasi-static approximation for 6 degrees-of-freedom haptic
/// rendering", 2003); so the coupling's wrench on the pen is that of the penalty forces. Every tick goes to the
/// balance of the springs as they look from where the part is, linear and only pushing. Parts interpenetrate: the depth
/// is force by stiffness.
class PenaltyLoop final : public ProxyLoop {
 public:
  PenaltyLoop(const Scene& scene, const ContactSettings& settings, const MassProperties& mass);

  void step(const Pose& Y, double dt, std::int64_t deadline_ns, TickReport& report) override;
  bool take_over(const TickReport& last, const Pose& Y, const std::vector<bool>* fresh,
                 std::int64_t deadline_ns) override;
  const Pose& pose() const override { return X_; }
  const std::vector<Contact>& constraints() const override { return constraints_; }
  const InitialContactReport& start() const override { return start_.report(); }

 private:
  /// A spring at a vertex: gap + row · (dp, dr), in the world.
  struct Spring {
    double gap;
    Vec6 row;
  };

  /// Springs within `reach` of the present pose.
  void collect(double reach, TickReport& report);
  /// The displacement at which linear springs balance the pull to `error`; `made` is what this tick has made so far.
  Vec6 balance(const Vec6& error, const Vec6& made, double dt) const;
  void move(const Displacement& d);
  /// Fixed parts within `distance` (m) that are not suspended, into near_.
  void query(double distance);
  double size(const Displacement& d) const { return d.dp.norm() + radius_ * d.dr.norm(); }

  ContactSettings settings_;
  CouplingSettings coupling_;
  Vec3 center_;
  double radius_;
  BoundingSpheres spheres_;
  std::vector<PartId> ids_;  ///< of the fixed parts
  std::vector<Pose> poses_;  ///< likewise
  std::vector<VertexShell> shells_;
  InitialContacts start_;
  std::unique_ptr<MotionCheck> check_;  ///< tells when suspended pairs are free; null when none is
  std::vector<std::uint32_t> near_;
  std::vector<ShellPoint> points_;
  std::vector<Spring> springs_;
  std::vector<Contact> constraints_;  ///< the springs' vertices, for whoever looks on; gaps may be negative
  bool collected_ = false;            ///< the springs are those of X_
  Pose X_;
};

}  // namespace tegotae
