#pragma once

#include "device/options.hpp"

namespace tegotae::apps {

/// Runs the device until SIGINT, SIGTERM or SIGHUP; then the force is off and the segment gone. Returns the exit code.
int run_device(const DeviceOptions& options);

}  // namespace tegotae::apps
