#pragma once

#include <string>

#include "tegotae/device/script.hpp"
#include "tegotae/device/simulated_device.hpp"
#include "tegotae/servo/safety.hpp"
#include "tegotae/sim/scene.hpp"

namespace tegotae {

/// What a scene file says: the scene, the pen, and what moves it.
struct SceneFile {
  std::string path;
  Scene scene;
  SimulatedDeviceSettings device;
  StylusScript script;      ///< what the operator's hand does
  SafetySettings safety{};  ///< of the servo in this process; a device in another one has its own
  double scale = 1;         ///< meters that the held part moves for a meter of the pen
};

/// Reads a scene file (TOML, see docs/scene-file.md) and the meshes it names; parts with the same file and unit share
/// one mesh. Paths in the file are relative to its folder. Throws Error `file:line: table.key: reason` at an unknown
/// key, a wrong type, a missing file, an impossible value, or a mesh that cannot be used.
SceneFile load_scene(const std::string& path);

}  // namespace tegotae
