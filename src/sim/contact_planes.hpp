#pragma once

#include <vector>

#include "lp/least_distance.hpp"
#include "resolve/metric.hpp"
#include "tegotae/core/contact_force.hpp"
#include "tegotae/coupling/contact_planes.hpp"
#include "tegotae/coupling/coupling.hpp"

namespace tegotae {

/// What the limits at X do to a pen at Y: the forces with which they hold the part against the coupling's springs, and
/// the planes that a servo needs to bring X up to date by itself. Allocates only when it is made.
class PlanePicker {
 public:
  /// For at most `capacity` limits; `scale`: Scene::scale.
  PlanePicker(int capacity, const CouplingSettings& coupling, double scale)
      : solver_(capacity),
        rows_(capacity),
        bounds_(static_cast<std::size_t>(capacity)),
        stiffness_(coupling.stiffness / scale),
        torsional_stiffness_(coupling.torsional_stiffness) {}

  /// `metric` is the coupling's, oriented as X is. First the limits that carry force where X would go on towards Y
  /// (they keep the gap `keep`), then those with the least room. No planes and no forces when the programme stalls.
  void pick(const std::vector<Contact>& limits, const Metric& metric, const Pose& X, const Pose& Y, const Vec3& center,
            double keep, ContactPlanes& planes, ContactForces& forces) noexcept;
  /// What the springs pull, `d` from X to Y, at the center of mass.
  Wrench pull(const Displacement& d) const noexcept { return {-stiffness_ * d.dp, -torsional_stiffness_ * d.dr}; }

 private:
  static void add(const Contact& contact, const Vec3& center_W, double room, ContactPlanes& planes) noexcept;

  LeastDistanceSolver solver_;
  LowRankMatrix rows_;
  std::vector<double> bounds_;  // minus the room of each limit
  double stiffness_;            // N a meter of the world
  double torsional_stiffness_;
};

}  // namespace tegotae
