#include "tegotae/coupling/coupling.hpp"

namespace tegotae {

Wrench coupling_wrench(const CouplingSettings& settings, const ProxyState& x, const Pose& Y, const Twist& Y_velocity,
                       const Vec3& center) noexcept {
  if (!x.touching) return {};
  const Displacement error = displacement(Y, x.X, center);
  return {settings.stiffness * error.dp + settings.damping * (x.velocity.v - Y_velocity.v),
          settings.torsional_stiffness * error.dr + settings.torsional_damping * (x.velocity.w - Y_velocity.w)};
}

}  // namespace tegotae
