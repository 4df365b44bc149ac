#include "resolve/friction_rows.hpp"

#include <algorithm>
#include <utility>

#include "lp/tangents.hpp"

namespace tegotae {

FrictionRows::FrictionRows(std::vector<double> mu_of_part, int capacity)
    : mu_of_part_(std::move(mu_of_part)),
      any_(std::any_of(mu_of_part_.begin(), mu_of_part_.end(), [](double mu) { return mu > 0; })) {
  if (!any_) return;
  mu_.resize(static_cast<std::size_t>(capacity));
  tangents_.resize(static_cast<std::size_t>(capacity));
  places_.resize(static_cast<std::size_t>(capacity));
}

bool FrictionRows::fill(const std::vector<Contact>& contacts, const Metric& metric) noexcept {
  if (!any_) return false;
  if (metric.axes() != axes_) made_ = 0;
  axes_ = metric.axes();
  const Mat3 turns = metric.turns();
  const std::size_t rows = std::min(contacts.size(), mu_.size());
  bool found = false;
  for (std::size_t i = 0; i < rows; ++i) {
    const Contact& c = contacts[i];
    // A plane between two triangles is not a surface that could rub.
    mu_[i] = c.age == kOneShotAge || c.part.index >= mu_of_part_.size() ? 0 : mu_of_part_[c.part.index];
    Place& at = places_[i];
    if (!(mu_[i] > 0)) {
      at = {};
      continue;
    }
    found = true;
    if (i < made_ && at.n == c.n && at.r == c.r) continue;
    at = {c.n, c.r};
    const Tangents tangents(c.n);
    for (int k = 0; k < 2; ++k) {
      const Vec3& e = tangents.direction[k];
      tangents_[i].row[k] << e, turns * c.r.cross(e);
    }
  }
  made_ = std::max(made_, rows);
  return found;
}

}  // namespace tegotae
