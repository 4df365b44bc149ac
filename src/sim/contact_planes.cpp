#include "sim/contact_planes.hpp"

#include <algorithm>
#include <limits>

namespace tegotae {

void PlanePicker::add(const Contact& contact, const Vec3& center_W, double room, ContactPlanes& planes) noexcept {
  planes.planes[static_cast<std::size_t>(planes.count++)] = {contact.n, center_W + contact.r, room};
}

void PlanePicker::pick(const std::vector<Contact>& limits, const Metric& metric, const Pose& X, const Pose& Y,
                       const Vec3& center, double keep, ContactPlanes& planes, ContactForces& forces) noexcept {
  planes.count = forces.count = 0;
  forces.available = false;
  planes.X = X;
  planes.pen = Y;
  const Displacement error = displacement(X, Y, center);
  forces.lag = pull(error);
  const std::size_t n = std::min(limits.size(), bounds_.size());
  if (n == 0) return;
  rows_.clear();
  for (std::size_t i = 0; i < n; ++i) {
    rows_.push_row(metric.row(limits[i]));
    bounds_[i] = std::min(keep, limits[i].gap) - limits[i].gap;
  }
  const QpResult& qp = solver_.solve(rows_, bounds_.data(), metric.whiten(error));
  if (qp.status != LpStatus::optimal) return;
  // What the solution still goes is not held by contacts: the springs pull the part there.
  forces.lag = pull(metric.unwhiten(qp.z));
  forces.available = true;
  const Vec3 center_W = X * center;
  const auto take = [&](std::size_t i) {
    add(limits[i], center_W, -bounds_[i], planes);
    bounds_[i] = -std::numeric_limits<double>::infinity();  // taken
  };
  for (int k = 0; k < qp.multipliers.count; ++k) {
    const auto i = static_cast<std::size_t>(qp.multipliers.index[static_cast<std::size_t>(k)]);
    const Contact& c = limits[i];
    forces.items[static_cast<std::size_t>(forces.count++)] = {
        c.part,      center_W + c.r, c.n, c.gap, stiffness_ * qp.multipliers.value[static_cast<std::size_t>(k)],
        c.feature_a, c.feature_b};
    take(i);
  }
  while (planes.count < ContactPlanes::kMost && static_cast<std::size_t>(planes.count) < n)
    take(static_cast<std::size_t>(std::max_element(bounds_.begin(), bounds_.begin() + static_cast<std::ptrdiff_t>(n)) -
                                  bounds_.begin()));
}

}  // namespace tegotae
