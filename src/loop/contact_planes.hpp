#pragma once

#include <vector>

#include "lp/friction_solver.hpp"
#include "lp/least_distance.hpp"
#include "resolve/friction_rows.hpp"
#include "resolve/metric.hpp"
#include "tegotae/core/contact_force.hpp"
#include "tegotae/coupling/contact_planes.hpp"
#include "tegotae/coupling/coupling.hpp"

namespace tegotae {

/// What the constraints at X do to a pen at Y: the forces with which they hold the part against the coupling's springs,
/// and the planes that a servo needs to bring X up to date by itself. Allocates only when it is made.
class PlanePicker {
 public:
  /// For at most `capacity` constraints; `scale`: Scene::scale.
  PlanePicker(int capacity, const CouplingSettings& coupling, double scale)
      : solver_(capacity),
        friction_solver_(capacity),
        rows_(capacity),
        bounds_(static_cast<std::size_t>(capacity)),
        stiffness_(coupling.stiffness / scale),
        torsional_stiffness_(coupling.torsional_stiffness) {
    forces_.reserve(static_cast<std::size_t>(FrictionActiveSet::most_forces()));
  }

  /// `metric` is the coupling's, oriented as X is. First the constraints that carry force where X would go on towards Y
  /// (they keep the gap `margin`), then those with the least room. No planes and no forces when the program stalls.
  /// `friction` is scratch for the constraints' tangents. `guess`: forces that may hold the part there, by constraint,
  /// or none; with friction they are what is told when `deadline_ns` passes, and what they do not hold is the lag.
  void pick(const std::vector<Contact>& constraints, const Metric& metric, FrictionRows& friction, const Pose& X,
            const Pose& Y, const Vec3& center, double margin, const std::vector<FrictionForce>& guess,
            std::int64_t deadline_ns, ContactPlanes& planes, ContactForces& forces) noexcept;
  /// What the springs pull, `d` from X to Y, at the center of mass.
  Wrench pull(const Displacement& d) const noexcept { return {-stiffness_ * d.dp, -torsional_stiffness_ * d.dr}; }

 private:
  /// Sets forces_ and what the part still goes, in whitened coordinates; false when the program stalls.
  bool solve(const std::vector<Contact>& constraints, const Metric& metric, FrictionRows& friction, const Vec6& wanted,
             const std::vector<FrictionForce>& guess, std::int64_t deadline_ns, Vec6& left) noexcept;

  LeastDistanceSolver solver_;
  FrictionSolver friction_solver_;
  std::vector<FrictionForce> forces_;
  bool rubs_ = false;  // one of the constraints has friction
  LowRankMatrix rows_;
  std::vector<double> bounds_;  // minus the clearance of each constraint
  double stiffness_;            // N a meter of the world
  double torsional_stiffness_;
};

}  // namespace tegotae
