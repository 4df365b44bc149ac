#include "device/make_device.hpp"

#include "tegotae/core/error.hpp"
#include "tegotae/device/input_devices.hpp"
#include "tegotae/device/openhaptics_device.hpp"
#include "tegotae/device/simulated_device.hpp"

namespace tegotae::apps {

std::unique_ptr<Device> make_device(const DeviceOptions& options) {
  if (options.type != "simulated" && !options.script.empty()) throw Error("--script is for --type simulated");
  if (options.type != "openhaptics" && !options.pen.empty()) throw Error("--pen is for --type openhaptics");
  if (options.type == "simulated") {
    if (options.script.empty()) throw Error("--type simulated needs --script FILE, what the hand does");
    SimulatedDeviceSettings settings;
    settings.wall_clock = true;
    settings.wait_for_application = true;
    return std::make_unique<SimulatedDevice>(settings, read_script(options.script));
  }
  if (options.type == "openhaptics") {
    OpenHapticsSettings settings;
    settings.device = options.pen;
    return std::make_unique<OpenHapticsDevice>(settings);
  }
  return options.type == "spacemouse" ? make_spacemouse() : make_gamepad();
}

}  // namespace tegotae::apps
