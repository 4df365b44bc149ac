#pragma once

#include <memory>

#include "device/options.hpp"
#include "tegotae/device/device.hpp"

namespace tegotae::apps {

/// The device that the options ask for, not started. Throws Error where an option is missing, or a backend.
std::unique_ptr<Device> make_device(const DeviceOptions& options);

}  // namespace tegotae::apps
