#pragma once

#include <string>

#include "tegotae/loop/haptic_loop.hpp"

namespace tegotae {

/// `scene` with the bounds of its torsional stiffness, where the file leaves that open, and of the weight, taken from
/// the device of another process, "shm:NAME". Throws Error when there is none.
Scene bounded_by(Scene scene, const std::string& device);

/// The torsional stiffness that `loop` over `scene` has, and why.
std::string torsion_text(const Scene& scene, const HapticLoop& loop);

}  // namespace tegotae
