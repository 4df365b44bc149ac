// With SDL's virtual pad.
#include <SDL.h>

#include <cmath>

#include "catch.hpp"
#include "device/moving_pen.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/device/input_devices.hpp"

using namespace tegotae;
using test::read_until;

namespace {

/// A pad that is not there: axes and buttons in the order of SDL's game controllers.
class VirtualPad {
 public:
  VirtualPad() {
    index_ = SDL_JoystickAttachVirtual(SDL_JOYSTICK_TYPE_GAMECONTROLLER, SDL_CONTROLLER_AXIS_MAX,
                                       SDL_CONTROLLER_BUTTON_MAX, 0);
    REQUIRE(index_ >= 0);
    pad_ = SDL_JoystickOpen(index_);
    REQUIRE(pad_ != nullptr);
    // A trigger's rest is the lower end of its axis.
    set(SDL_CONTROLLER_AXIS_TRIGGERLEFT, -1);
    set(SDL_CONTROLLER_AXIS_TRIGGERRIGHT, -1);
  }
  ~VirtualPad() { detach(); }
  void set(SDL_GameControllerAxis axis, double value) const {
    REQUIRE(SDL_JoystickSetVirtualAxis(pad_, axis, static_cast<Sint16>(std::lround(32767 * value))) == 0);
  }
  void press(SDL_GameControllerButton button, bool down) const {
    REQUIRE(SDL_JoystickSetVirtualButton(pad_, button, down ? 1 : 0) == 0);
  }
  void detach() {
    if (pad_ == nullptr) return;
    SDL_JoystickClose(pad_);
    pad_ = nullptr;
    SDL_JoystickDetachVirtual(index_);
  }

 private:
  int index_ = -1;
  SDL_Joystick* pad_ = nullptr;
};

struct Sdl {
  Sdl() { REQUIRE(SDL_Init(SDL_INIT_GAMECONTROLLER) == 0); }
  ~Sdl() { SDL_Quit(); }
};

bool moves(Device& pen, const Vec3& v, const Vec3& w) {
  return read_until(
      pen, [&](const DeviceState& s) { return (s.velocity.v - v).norm() < 1e-4 && (s.velocity.w - w).norm() < 1e-3; });
}

const Vec3 kZero = Vec3::Zero();

}  // namespace

TEST_CASE("sticks, triggers and shoulder buttons move the pen", "[gamepad]") {
  const Sdl sdl;
  const VirtualPad pad;
  const std::unique_ptr<Device> pen = make_gamepad();
  pen->start();
  CHECK(pen->status() == DeviceStatus::ready);
  CHECK(pen->reason() == ForceOff::no_force);
  CHECK(moves(*pen, kZero, kZero));

  pad.set(SDL_CONTROLLER_AXIS_LEFTX, 1);  // to the right
  CHECK(moves(*pen, Vec3(0.05, 0, 0), kZero));
  pad.set(SDL_CONTROLLER_AXIS_LEFTX, 0);
  pad.set(SDL_CONTROLLER_AXIS_LEFTY, -1);  // pushed away
  CHECK(moves(*pen, Vec3(0, 0.05, 0), kZero));
  pad.set(SDL_CONTROLLER_AXIS_LEFTY, 0);
  pad.set(SDL_CONTROLLER_AXIS_TRIGGERRIGHT, 1);
  CHECK(moves(*pen, Vec3(0, 0, -0.05), kZero));
  pad.set(SDL_CONTROLLER_AXIS_TRIGGERRIGHT, -1);
  pad.set(SDL_CONTROLLER_AXIS_TRIGGERLEFT, 1);
  CHECK(moves(*pen, Vec3(0, 0, 0.05), kZero));
  pad.set(SDL_CONTROLLER_AXIS_TRIGGERLEFT, -1);
  pad.set(SDL_CONTROLLER_AXIS_RIGHTX, 1);  // to the right: clockwise from above
  CHECK(moves(*pen, kZero, Vec3(0, 0, -0.8)));
  pad.set(SDL_CONTROLLER_AXIS_RIGHTX, 0);
  pad.set(SDL_CONTROLLER_AXIS_RIGHTY, -1);  // pushed away: the top tilts away
  CHECK(moves(*pen, kZero, Vec3(-0.8, 0, 0)));
  pad.set(SDL_CONTROLLER_AXIS_RIGHTY, 0);
  pad.press(SDL_CONTROLLER_BUTTON_RIGHTSHOULDER, true);  // the top tilts to the right
  CHECK(moves(*pen, kZero, Vec3(0, 0.8, 0)));
  pad.press(SDL_CONTROLLER_BUTTON_RIGHTSHOULDER, false);
  CHECK(moves(*pen, kZero, kZero));
  pad.press(SDL_CONTROLLER_BUTTON_B, true);
  CHECK(read_until(*pen, [](const DeviceState& s) { return s.buttons == 2; }));
  pen->stop();
}

TEST_CASE("a pad that is unplugged stops the pen, one that comes back moves it again", "[gamepad]") {
  const Sdl sdl;
  VirtualPad pad;
  const std::unique_ptr<Device> pen = make_gamepad();
  pen->start();
  pad.set(SDL_CONTROLLER_AXIS_LEFTX, 1);
  CHECK(moves(*pen, Vec3(0.05, 0, 0), kZero));
  pad.detach();
  CHECK(moves(*pen, kZero, kZero));
  CHECK(read_until(*pen, [&](const DeviceState&) { return pen->reason() == ForceOff::disconnected; }));
  const VirtualPad again;
  again.set(SDL_CONTROLLER_AXIS_LEFTX, -1);
  CHECK(moves(*pen, Vec3(-0.05, 0, 0), kZero));
  pen->stop();
}

TEST_CASE("without a pad the message says so", "[gamepad]") {
  CHECK_THROWS_WITH(make_gamepad()->start(), Catch::Contains("none found"));
}
