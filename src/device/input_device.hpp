#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "device/rate_control.hpp"
#include "tegotae/device/device.hpp"

namespace tegotae {

struct InputState {
  Deflection deflection;
  std::uint32_t buttons = 0;
};

/// Where deflections come from. Made, used and destroyed in one thread, which may wait.
class InputDriver {
 public:
  virtual ~InputDriver() = default;
  /// Throws Error when there is no such device.
  virtual void open() = 0;
  virtual void close() noexcept = 0;
  /// Waits for news for about 10 ms at most. False when the device is lost.
  virtual bool poll(InputState& state) noexcept = 0;
};

/// A device without force that integrates what `source` says.
std::unique_ptr<Device> make_input_device(const std::string& name, std::unique_ptr<InputDriver> source,
                                          const RateControlSettings& settings);

}  // namespace tegotae
