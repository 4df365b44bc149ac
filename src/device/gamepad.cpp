#include <SDL.h>

#include <algorithm>
#include <array>

#include "device/input_device.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

namespace {

constexpr double kFullDeflection = 32767.0;
constexpr Uint32 kWaitMs = 4;  // a pad reports every 4 to 8 ms

class Gamepad final : public InputDriver {
 public:
  ~Gamepad() override {
    Gamepad::close();
    if (initialized_) SDL_QuitSubSystem(SDL_INIT_GAMECONTROLLER);
  }

  void open() override {
    initialize();
    SDL_GameControllerUpdate();  // also finds pads that came since
    for (int i = 0; i < SDL_NumJoysticks() && pad_ == nullptr; ++i)
      if (SDL_IsGameController(i)) pad_ = SDL_GameControllerOpen(i);
    if (pad_ == nullptr) throw Error(ErrorKind::device, "gamepad: none found; connect one that SDL2 knows");
  }

  void close() noexcept override {
    if (pad_ != nullptr) SDL_GameControllerClose(pad_);
    pad_ = nullptr;
  }

  bool poll(InputState& state) noexcept override {
    SDL_Delay(kWaitMs);
    SDL_GameControllerUpdate();
    if (SDL_GameControllerGetAttached(pad_) == SDL_FALSE) return false;
    // Sticks: to the right and toward the user are positive.
    state.deflection.linear = {axis(SDL_CONTROLLER_AXIS_LEFTX), -axis(SDL_CONTROLLER_AXIS_LEFTY),
                               axis(SDL_CONTROLLER_AXIS_TRIGGERLEFT) - axis(SDL_CONTROLLER_AXIS_TRIGGERRIGHT)};
    state.deflection.angular = {
        axis(SDL_CONTROLLER_AXIS_RIGHTY),
        pressed(SDL_CONTROLLER_BUTTON_RIGHTSHOULDER) - pressed(SDL_CONTROLLER_BUTTON_LEFTSHOULDER),
        -axis(SDL_CONTROLLER_AXIS_RIGHTX)};
    state.buttons = 0;
    constexpr std::array<SDL_GameControllerButton, 4> kButtons = {SDL_CONTROLLER_BUTTON_A, SDL_CONTROLLER_BUTTON_B,
                                                                  SDL_CONTROLLER_BUTTON_X, SDL_CONTROLLER_BUTTON_Y};
    for (std::size_t i = 0; i < kButtons.size(); ++i)
      if (pressed(kButtons[i]) != 0) state.buttons |= 1u << i;
    return true;
  }

 private:
  void initialize() {
    if (initialized_) return;
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");                // signals are the program's
    SDL_SetHint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "1");  // there is no window that could have the focus
    if (SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER) != 0)
      throw Error(ErrorKind::device, std::string("gamepad: SDL2 cannot be used: ") + SDL_GetError());
    initialized_ = true;
  }

  double axis(SDL_GameControllerAxis which) const {
    return std::max(-1.0, SDL_GameControllerGetAxis(pad_, which) / kFullDeflection);
  }
  double pressed(SDL_GameControllerButton which) const { return SDL_GameControllerGetButton(pad_, which); }

  SDL_GameController* pad_ = nullptr;
  bool initialized_ = false;
};

}  // namespace

std::unique_ptr<Device> make_gamepad(const RateControlSettings& settings) {
  return make_input_device("gamepad", std::make_unique<Gamepad>(), settings);
}

}  // namespace tegotae
