#include "loop/contact_planes.hpp"

#include <algorithm>
#include <limits>

#include "lp/force_reduction.hpp"
#include "lp/tangents.hpp"

namespace tegotae {
namespace {

// What a contact that carries force is off its kept gap (m).
constexpr double kTouching = 1e-7;

}  // namespace

bool PlanePicker::solve(const std::vector<Contact>& constraints, const Metric& metric, FrictionRows& friction,
                        const Vec6& wanted, const std::vector<FrictionForce>& guess, std::int64_t deadline_ns,
                        Vec6& left) noexcept {
  forces_.clear();
  rubs_ = friction.fill(constraints, metric);
  if (rubs_) {
    // Forces that hold the part here press where it touches, to the last digits of a gap.
    for (const FrictionForce& f : guess)
      if (double& bound = bounds_[static_cast<std::size_t>(f.row)]; bound > -kTouching) bound = 0;
    const FrictionProblem problem = friction.problem(rows_, bounds_.data(), wanted, deadline_ns);
    const FrictionResult& r = friction_solver_.solve(problem, guess);
    if (r.status != LpStatus::optimal) return false;
    forces_.assign(r.forces.begin(), r.forces.end());
    reduce_to_six(problem, forces_);
    left = r.z;
    return true;
  }
  const QpResult& qp = solver_.solve(rows_, bounds_.data(), wanted);
  if (qp.status != LpStatus::optimal) return false;
  for (int k = 0; k < qp.multipliers.count; ++k) {
    forces_.push_back({});
    forces_.back().row = qp.multipliers.index[static_cast<std::size_t>(k)];
    forces_.back().normal = qp.multipliers.value[static_cast<std::size_t>(k)];
  }
  left = qp.z;
  return true;
}

void PlanePicker::pick(const std::vector<Contact>& constraints, const Metric& metric, FrictionRows& friction,
                       const Pose& X, const Pose& Y, const Vec3& center, double margin,
                       const std::vector<FrictionForce>& guess, std::int64_t deadline_ns, ContactPlanes& planes,
                       ContactForces& forces) noexcept {
  planes.count = forces.count = 0;
  forces.available = false;
  planes.X = X;
  planes.pen = Y;
  const Displacement error = displacement(X, Y, center);
  forces.lag = pull(error);
  const std::size_t n = std::min(constraints.size(), bounds_.size());
  if (n == 0) return;
  rows_.clear();
  for (std::size_t i = 0; i < n; ++i) {
    rows_.push_row(metric.row(constraints[i]));
    bounds_[i] = std::min(margin, constraints[i].gap) - constraints[i].gap;
  }
  Vec6 left;
  if (!solve(constraints, metric, friction, metric.whiten(error), guess, deadline_ns, left)) return;
  // What the solution still goes is not held by contacts: the springs pull the part there.
  forces.lag = pull(metric.unwhiten(left));
  forces.available = true;
  const Vec3 center_W = X * center;
  const auto take = [&](std::size_t i) {
    planes.planes[static_cast<std::size_t>(planes.count++)] = {constraints[i].n, center_W + constraints[i].r,
                                                               -bounds_[i], rubs_ ? friction.mu(i) : 0};
    bounds_[i] = -std::numeric_limits<double>::infinity();  // taken
  };
  for (const FrictionForce& f : forces_) {
    const auto i = static_cast<std::size_t>(f.row);
    const Contact& c = constraints[i];
    ContactForce& out = forces.items[static_cast<std::size_t>(forces.count++)];
    out = {c.part, center_W + c.r, c.n, c.gap, stiffness_ * f.normal, c.feature_a, c.feature_b};
    out.mu = rubs_ ? friction.mu(i) : 0;
    const Tangents tangents(c.n);
    for (int k = 0; k < 2 && out.mu > 0; ++k) out.friction += stiffness_ * f.tangential[k] * tangents.direction[k];
    take(i);
  }
  while (planes.count < ContactPlanes::kMax && static_cast<std::size_t>(planes.count) < n)
    take(static_cast<std::size_t>(std::max_element(bounds_.begin(), bounds_.begin() + static_cast<std::ptrdiff_t>(n)) -
                                  bounds_.begin()));
}

}  // namespace tegotae
