#include "tegotae/device/device.hpp"

namespace tegotae {

const char* to_string(DeviceStatus status) noexcept {
  switch (status) {
    case DeviceStatus::uninitialized:
      return "not started";
    case DeviceStatus::ready:
      return "ready, force off";
    case DeviceStatus::enabled:
      return "force on";
  }
  return "unknown device status";
}

const char* to_string(ForceOff reason) noexcept {
  switch (reason) {
    case ForceOff::none:
      return "the force is on";
    case ForceOff::button:
      return "the force button of the device is off";
    case ForceOff::velocity:
      return "the pen moved too fast";
    case ForceOff::watchdog:
      return "the contact loop's heartbeat is too old";
    case ForceOff::software:
      return "no application asks for force";
    case ForceOff::disconnected:
      return "the device does not answer";
    case ForceOff::dead_man:
      return "the dead-man switch is released";
    case ForceOff::not_finite:
      return "a pose, velocity or setting is not finite";
    case ForceOff::workspace:
      return "the pen left its workspace";
    case ForceOff::energy:
      return "the coupling became unstable";
    case ForceOff::thermal:
      return "the motors of the device are too warm";
    case ForceOff::engage:
      return "waiting for a small force: let go a little";
    case ForceOff::clutched:
      return "the pen is clutched";
    case ForceOff::silent:
      return "the pen has sent no new sample for too long";
    case ForceOff::device_fault:
      return "the device reports a fault";
    case ForceOff::force_exceeded:
      return "the application asked for more than the device may render";
    case ForceOff::no_force:
      return "the device renders no force";
  }
  return "unknown reason";
}

}  // namespace tegotae
