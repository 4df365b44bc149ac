#pragma once

#include <memory>

#include "tegotae/core/export.hpp"
#include "tegotae/device/device.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// How the deflection of an input that springs back to its middle moves the pen. Speeds grow with the square of the
/// deflection beyond the dead zone.
struct RateControlSettings {
  double speed = 0.05;      ///< m/s at full deflection
  double turn_rate = 0.8;   ///< rad/s at full deflection
  double dead_zone = 0.1;   ///< of the full deflection, from 0 to below 1
  double reach = 0.01;      ///< m: the pen waits when it is so far ahead of a part that cannot follow
  double turn_reach = 0.2;  ///< rad, the same
};

/// Inputs that move the part without force, so that anyone can try the library. Their pen moves only while an
/// application is attached. A thread of their own listens to them; read() never waits. Where an input is lost, the pen
/// rests, reason() is `disconnected`, and twice a second it is looked for again.
///
/// These throw Error for a setting out of range, and where the build has no such backend; start() throws when there is
/// no such device.

/// A SpaceMouse through the daemon spacenavd and libspnav; one in a process.
std::unique_ptr<Device> make_spacemouse(const RateControlSettings& settings = {});
/// The first gamepad that SDL2 finds. Left stick: right and away; triggers: down (right one) and up; right stick: turn
/// about the vertical and tilt; shoulder buttons: roll.
std::unique_ptr<Device> make_gamepad(const RateControlSettings& settings = {});

}  // namespace tegotae
