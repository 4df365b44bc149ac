// tegotae-device: a haptic device and its servo as a process of its own.
#include "device/options.hpp"
#include "device/run_device.hpp"
#include "device/status.hpp"
#include "shared/guarded_main.hpp"
#include "tegotae/core/error.hpp"

using namespace tegotae;
using namespace tegotae::apps;

int main(int argc, char** argv) {
  CLI::App app("A haptic device and its servo, for applications that attach with --device shm:NAME.", "tegotae-device");
  DeviceOptions options;
  add_device_options(app, options);
  return guarded_main(app, argc, argv, [&] {
    if (options.status) return print_status(options.name, options.json);
    if (options.type.empty()) throw Error("give --type or --status (see --help)");
    return run_device(options);
  });
}
