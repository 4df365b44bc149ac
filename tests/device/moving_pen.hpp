// Reads an input device as the servo does until it does what a test waits for.
#pragma once

#include <chrono>
#include <functional>
#include <thread>

#include "tegotae/device/device.hpp"

namespace tegotae::test {

/// Reads every millisecond, a part following at once, until `wanted`; false after ten seconds.
inline bool read_until(Device& device, const std::function<bool(const DeviceState&)>& wanted) {
  for (int i = 0; i < 10'000; ++i) {
    device.set_tracking_error({});
    if (wanted(device.read())) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

}  // namespace tegotae::test
