#include "tegotae/device/limits.hpp"

#include <algorithm>

namespace tegotae {

Wrench saturated(const Wrench& wrench, const WrenchLimits& limits) noexcept {
  if (!wrench.force.allFinite() || !wrench.torque.allFinite()) return {};
  // stableNorm: squares of finite but absurd entries overflow.
  const double force = wrench.force.stableNorm();
  const double torque = wrench.torque.stableNorm();
  double scale = 1.0;
  if (force > limits.force) scale = std::min(scale, limits.force / force);
  if (torque > limits.torque) scale = std::min(scale, limits.torque / torque);
  return {scale * wrench.force, scale * wrench.torque};
}

}  // namespace tegotae
