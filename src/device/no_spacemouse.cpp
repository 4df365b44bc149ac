#include "tegotae/core/error.hpp"
#include "tegotae/device/input_devices.hpp"

namespace tegotae {

std::unique_ptr<Device> make_spacemouse(const RateControlSettings&) {
  throw Error(ErrorKind::device,
              "SpaceMouse: this build has no support for it; install libspnav-dev, configure and build again");
}

}  // namespace tegotae
