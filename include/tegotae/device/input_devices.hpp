#pragma once

#include <memory>

#include "tegotae/core/export.hpp"
#include "tegotae/device/device.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// How the deflection of a self-centering input moves the pen. Speeds grow with the square of the deflection beyond the
/// dead zone.
struct RateControlSettings {
  double speed = 0.05;      ///< m/s at full deflection
  double turn_rate = 0.8;   ///< rad/s at full deflection
  double dead_zone = 0.1;   ///< fraction of the full deflection, from 0 to below 1
  double reach = 0.01;      ///< m: the pen waits when it is this far ahead of a part that cannot follow
  double turn_reach = 0.2;  ///< rad; the same for the rotation
};

/// Inputs that move the part without force, for trying the library without a haptic pen. Their pen moves only while an
/// application is attached. Each reads its hardware in a thread of its own, so that read() never waits. When an input
/// is lost, the pen rests, reason() is `disconnected`, and the thread searches for the input twice a second.
///
/// Both functions throw Error for a setting out of range (kind setting), and when the build has no such backend.
/// start() throws Error when there is no such device.

/// Makes a pen of a SpaceMouse, through the daemon spacenavd and libspnav. A process can have one.
std::unique_ptr<Device> make_spacemouse(const RateControlSettings& settings = {});
/// Makes a pen of the first gamepad that SDL2 finds. The left stick moves right and away, the triggers move down (right
/// one) and up, the right stick turns about the vertical and tilts, and the shoulder buttons roll.
std::unique_ptr<Device> make_gamepad(const RateControlSettings& settings = {});

}  // namespace tegotae
