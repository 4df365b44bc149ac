#pragma once

#include <string>
#include <vector>

#include "tegotae/loop/scene.hpp"

namespace tegotae::experiments {

/// Where the pen is held (the held part's file frame, whose origin is its center of mass), and the wrench on the pen
/// that the scene's geometry and the coupling give for it.
struct Probe {
  Pose Y;
  Wrench expected;
};

/// A scene whose wrenches are known in closed form.
struct WrenchScene {
  std::string name;
  std::string formula;  ///< for people
  Scene scene;
  std::vector<Probe> probes;
};

/// A sphere in spherical and cylindrical sockets, a cone on a block, a pin in a slot, a square shaft in its socket,
/// pushed and turned by the pen in about `probes` ways each.
std::vector<WrenchScene> wrench_scenes(int probes);

}  // namespace tegotae::experiments
