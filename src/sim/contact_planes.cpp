#include "sim/contact_planes.hpp"

#include <algorithm>
#include <limits>

namespace tegotae {

void PlanePicker::add(const Contact& contact, const Vec3& center_W, double room, ContactPlanes& planes) noexcept {
  planes.planes[static_cast<std::size_t>(planes.count++)] = {contact.n, center_W + contact.r, room};
}

void PlanePicker::pick(const std::vector<Contact>& limits, const Metric& metric, const Pose& X, const Pose& Y,
                       const Vec3& center, double keep, ContactPlanes& planes) noexcept {
  planes.count = 0;
  planes.X = X;
  planes.pen = Y;
  const std::size_t n = std::min(limits.size(), bounds_.size());
  if (n == 0) return;
  rows_.clear();
  for (std::size_t i = 0; i < n; ++i) {
    rows_.push_row(metric.row(limits[i]));
    bounds_[i] = std::min(keep, limits[i].gap) - limits[i].gap;
  }
  const QpResult& qp = solver_.solve(rows_, bounds_.data(), metric.whiten(displacement(X, Y, center)));
  if (qp.status != LpStatus::optimal) return;
  const Vec3 center_W = X * center;
  const auto take = [&](std::size_t i) {
    add(limits[i], center_W, -bounds_[i], planes);
    bounds_[i] = -std::numeric_limits<double>::infinity();  // taken
  };
  for (int k = 0; k < qp.multipliers.count && planes.count < ContactPlanes::kMost; ++k)
    take(static_cast<std::size_t>(qp.multipliers.index[static_cast<std::size_t>(k)]));
  while (planes.count < ContactPlanes::kMost && static_cast<std::size_t>(planes.count) < n)
    take(static_cast<std::size_t>(std::max_element(bounds_.begin(), bounds_.begin() + static_cast<std::ptrdiff_t>(n)) -
                                  bounds_.begin()));
}

}  // namespace tegotae
