#pragma once

#include <vector>

#include "lp/least_distance.hpp"
#include "resolve/metric.hpp"
#include "tegotae/coupling/contact_planes.hpp"

namespace tegotae {

/// Picks from the limits at X those that a servo needs to bring X up to date by itself. Allocates only when it is made.
class PlanePicker {
 public:
  explicit PlanePicker(int capacity)
      : solver_(capacity), rows_(capacity), bounds_(static_cast<std::size_t>(capacity)) {}

  /// `metric` is oriented as X is. First the limits in use where X would go on towards Y (they keep the gap `keep`),
  /// then those with the least room.
  void pick(const std::vector<Contact>& limits, const Metric& metric, const Pose& X, const Pose& Y, const Vec3& center,
            double keep, ContactPlanes& planes) noexcept;

 private:
  void add(const Contact& contact, const Vec3& center_W, double room, ContactPlanes& planes) noexcept;

  LeastDistanceSolver solver_;
  LowRankMatrix rows_;
  std::vector<double> bounds_;  // minus the room of each limit
};

}  // namespace tegotae
