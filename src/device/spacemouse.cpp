#include <poll.h>
#include <sys/ioctl.h>

#include <algorithm>

#include "device/input_device.hpp"
#include "tegotae/core/error.hpp"

// Keeps its configuration, and with it X11 and the macros of that, away: only the daemon's socket is used.
#define SPNAV_CONFIG_H_
#include <spnav.h>

namespace tegotae {

namespace {

constexpr double kFullDeflection = 350.0;  // counts that the daemon sends when a SpaceMouse is pushed all the way
constexpr int kEventBytes = 32;            // eight 32-bit numbers on the daemon's socket
constexpr int kWaitMs = 10;

class SpaceMouse final : public InputDriver {
 public:
  ~SpaceMouse() override { SpaceMouse::close(); }

  void open() override {
    if (spnav_open() == -1)
      throw Error(ErrorKind::device,
                  "SpaceMouse: spacenavd does not answer; install and start it (package spacenavd), or say where its "
                  "socket is with SPNAV_SOCKET");
    open_ = true;
  }

  void close() noexcept override {
    if (open_) spnav_close();
    open_ = false;
  }

  bool poll(InputState& state) noexcept override {
    pollfd wait = {spnav_fd(), POLLIN, 0};
    if (::poll(&wait, 1, kWaitMs) <= 0) return true;
    // libspnav waits for the rest of an event that has come in part.
    int waiting = 0;
    if (ioctl(wait.fd, FIONREAD, &waiting) != 0) return false;
    if (waiting < kEventBytes) return waiting > 0 && (wait.revents & POLLHUP) == 0;
    spnav_event event;
    if (spnav_poll_event(&event) == 0) return true;
    if (event.type == SPNAV_EVENT_MOTION) state.deflection = deflection(event.motion);
    if (event.type == SPNAV_EVENT_BUTTON && event.button.bnum >= 0 && event.button.bnum < 32) {
      const std::uint32_t bit = std::uint32_t{1} << event.button.bnum;
      state.buttons = event.button.press != 0 ? state.buttons | bit : state.buttons & ~bit;
    }
    return true;
  }

 private:
  /// The daemon's x is to the right, y up, z away from the user, rotations left-handed as these axes are; the world's z
  /// is up and its y away.
  static Deflection deflection(const spnav_event_motion& m) {
    return {Vec3(m.x, m.z, m.y) / kFullDeflection, Vec3(m.rx, m.rz, m.ry) / kFullDeflection};
  }

  bool open_ = false;
};

}  // namespace

std::unique_ptr<Device> make_spacemouse(const RateControlSettings& settings) {
  return make_input_device("SpaceMouse", std::make_unique<SpaceMouse>(), settings);
}

}  // namespace tegotae
