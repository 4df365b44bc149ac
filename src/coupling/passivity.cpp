#include "coupling/passivity.hpp"

#include <algorithm>
#include <cmath>

namespace tegotae {

void Passivity::observe(const Displacement& moved, const Wrench& rendered, double stored, bool whole, double dt,
                        double steps) noexcept {
  const double stored_before = stored_;
  stored_ = stored;
  dt_ = dt;
  velocity_ = {};
  if (!(dt > 0)) return;
  velocity_ = {moved.dp / dt, moved.dr / dt};
  if (!whole) return;
  const double put_in = -rendered.force.dot(moved.dp) - rendered.torque.dot(moved.dr);
  const double damped = (settings_.device_damping * moved.dp.squaredNorm() +
                         settings_.device_torsional_damping * moved.dr.squaredNorm()) /
                        dt;
  const double gained = put_in + damped - (stored - stored_before);
  // Steps make up for what is missing in this tick alone; they are not a credit.
  const double energy = energy_ + (gained < 0 ? std::min(gained + steps, 0.0) : gained);
  // A jump of the pen is not this link's business, but must not spoil the sum for ever.
  energy_ = std::isfinite(energy) ? std::min(energy, settings_.credit) : 0;
}

Wrench Passivity::controller(double arm2) const noexcept {
  const double square = velocity_.v.squaredNorm() + arm2 * velocity_.w.squaredNorm();
  if (!acts() || !(square > 0) || !(dt_ > 0)) return {};
  const double damping = std::min(-energy_ / (dt_ * square), settings_.damping_most);
  return {-damping * velocity_.v, -damping * arm2 * velocity_.w};
}

}  // namespace tegotae
