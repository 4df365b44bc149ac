#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tegotae/core/export.hpp"
#include "tegotae/device/script.hpp"
#include "tegotae/device/simulated_device.hpp"
#include "tegotae/import/load.hpp"
#include "tegotae/loop/scene.hpp"
#include "tegotae/servo/safety.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// What a scene file says: the scene, the pen, and what moves it.
struct SceneFile {
  std::string path;                ///< of the file
  Scene scene;                     ///< parts, contact loop and coupling
  SimulatedDeviceSettings device;  ///< the pen without hardware, and its hand
  StylusScript script;             ///< what the operator's hand does
  SafetySettings safety{};         ///< of the servo in this process; a device in another one has its own
  std::string text{};              ///< of the file, as it was read
  /// All that was read: the file itself, the meshes and the script that it names. A recording replaces none of them.
  std::vector<std::string> files{};
};

/// Reads one mesh file, whose unit has this length in m: load_mesh, or load_mesh_isolated for files of unknown origin.
using MeshLoader = std::function<TriangleMesh(const std::string& path, double unit_in_m)>;

/// How a scene file is read.
struct SceneOptions {
  std::string hold;         ///< name of the part to hold, instead of the file's; empty: the file's
  bool held_needed = true;  ///< false: a file that holds no part is read too
  /// Called before the first mesh file is read and after each: how many are, of how many. One call at a time.
  std::function<void(std::size_t done, std::size_t total)> progress;
  MeshLoader load = load_mesh;  ///< reads the meshes; called in several threads at once
};

/// Reads a scene file (TOML, see docs/scene-file.md) and the meshes it names; parts with the same file and unit share
/// one mesh. Paths in the file are relative to its folder. Throws Error `file:line: table.key: reason` at an unknown
/// key, a wrong type, a missing file, an impossible value, or a mesh that cannot be used. Without a script in the file
/// the hand stays where the held part starts.
SceneFile load_scene(const std::string& path, const SceneOptions& options = {});

}  // namespace tegotae
