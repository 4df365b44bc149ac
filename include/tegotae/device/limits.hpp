#pragma once

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Upper bounds of a rendered wrench. The defaults are the peak figures of a PHANTOM Premium 1.5/6DOF.
struct WrenchLimits {
  double force = 8.5;     ///< N
  double torque = 0.188;  ///< N·m
};

/// Returns `wrench`, scaled down when its force or torque exceeds its limit. One factor scales both, so that their
/// directions and their ratio stay. Returns zero when an entry is not finite.
Wrench saturated(const Wrench& wrench, const WrenchLimits& limits) noexcept;

}  // namespace tegotae
