#include "tegotae/core/error.hpp"
#include "tegotae/device/input_devices.hpp"

namespace tegotae {

std::unique_ptr<Device> make_gamepad(const RateControlSettings&) {
  throw Error(ErrorKind::device,
              "gamepad: this build has no support for it; install libsdl2-dev, configure and build again");
}

}  // namespace tegotae
