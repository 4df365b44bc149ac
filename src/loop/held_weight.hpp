#pragma once

#include <optional>
#include <string>

#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/mesh/mass.hpp"

namespace tegotae {

/// The weight of the held part as the scene's settings have it; all zero unless it is on. Throws Error for a mass or a
/// gravity that cannot be, and for a resolver of the library that knows no weight.
HeldWeight held_weight(const Scene& scene, const MassProperties& mass);

/// The most that the hand is to carry (N) on a device whose motors stand for `continuous_force` (N; 0: not limited).
std::optional<double> weight_bound(double continuous_force);

/// In one line for people; empty when none is asked for.
std::string weight_text(const Scene& scene, const HapticLoop& loop);

}  // namespace tegotae
