#include "coupling/pen_steps.hpp"

#include <algorithm>
#include <cmath>

namespace tegotae {

namespace {

// Of a step: less is how poses are rounded, more is not a single step.
constexpr double kNoStep = 0.01, kOneStep = 1.5;
// Ticks; a pen that has waited longer has stood still.
constexpr int kLongestWait = 1000;

}  // namespace

double PenSteps::uncounted(std::size_t axis, double moved, double step) noexcept {
  Axis& a = axes_[axis];
  a.wait = std::min(a.wait + 1, kLongestWait);
  if (!(std::abs(moved) > kNoStep * step)) return 0;
  const int direction = moved > 0 ? 1 : -1;
  const double share = direction == a.direction ? 1.0 - 1.0 / a.wait : 1.0;
  a = {direction, 0};
  return std::abs(moved) < kOneStep * step ? share * moved * moved : 0;
}

double PenSteps::energy(const Displacement& moved, const CouplingSettings& coupling, double resolution,
                        double dt) noexcept {
  if (!(dt > 0) || !(resolution > 0)) return 0;
  const double angle = resolution / coupling_radius(coupling);
  double shift = 0, turn = 0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    shift += uncounted(static_cast<std::size_t>(i), moved.dp[i], resolution);
    turn += uncounted(static_cast<std::size_t>(i + 3), moved.dr[i], angle);
  }
  return (0.5 * coupling.stiffness + coupling.damping / dt) * shift +
         (0.5 * coupling.torsional_stiffness + coupling.torsional_damping / dt) * turn;
}

}  // namespace tegotae
