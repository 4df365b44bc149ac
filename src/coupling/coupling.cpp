#include "tegotae/coupling/coupling.hpp"

#include <algorithm>
#include <cmath>

namespace tegotae {

namespace {

// A part of a tenth of a millimeter, and one of a house: beyond, the program would be badly scaled.
constexpr double kMinRadius = 1e-4, kMaxRadius = 10;

}  // namespace

double coupling_radius(const CouplingSettings& settings, double scale) noexcept {
  const double square = settings.torsional_stiffness / settings.stiffness;
  // 0 / 0: nothing is felt, and any radius will do.
  return std::isnan(square) ? scale * coupling_radius({})
                            : std::clamp(scale * std::sqrt(square), kMinRadius, kMaxRadius);
}

double fitted_torsional_stiffness(double stiffness, double radius, double max_stiffness) noexcept {
  const double least = CouplingSettings().torsional_stiffness;
  return std::clamp(stiffness * radius * radius, least, std::max(least, max_stiffness));
}

Pose loaded(const Pose& Y, const Vec3& center, const CouplingSettings& settings, double scale,
            const Wrench& load) noexcept {
  Displacement d;
  if (settings.stiffness > 0) d.dp = scale / settings.stiffness * load.force;
  if (settings.torsional_stiffness > 0) d.dr = load.torque / settings.torsional_stiffness;
  // Without a turn the pen's very bits, but for the way.
  return d.dr.isZero() ? Pose{Y.q, Y.p + d.dp} : displaced(Y, center, d);
}

Wrench coupling_wrench(const CouplingSettings& settings, const ProxyState& x, const Pose& Y, const Twist& Y_velocity,
                       const Vec3& center) noexcept {
  if (!x.touching) return x.load;
  const Displacement error = displacement(Y, x.X, center);
  return {settings.stiffness * error.dp + settings.damping * (x.velocity.v - Y_velocity.v),
          settings.torsional_stiffness * error.dr + settings.torsional_damping * (x.velocity.w - Y_velocity.w)};
}

}  // namespace tegotae
