#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tegotae/core/export.hpp"
#include "tegotae/core/up_axis.hpp"
#include "tegotae/device/script.hpp"
#include "tegotae/device/simulated_device.hpp"
#include "tegotae/import/load.hpp"
#include "tegotae/loop/scene.hpp"
#include "tegotae/servo/safety.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Contents of a scene file: the scene, the pen, and what moves it.
struct SceneFile {
  std::string path;                ///< path of the file
  Scene scene;                     ///< parts, contact loop and coupling
  SimulatedDeviceSettings device;  ///< the pen without hardware, and its hand
  StylusScript script;             ///< motion of the operator's hand
  SafetySettings safety{};         ///< safety chain of a servo in this process; a device in another one has its own
  std::string text{};              ///< text of the file, as it was read
  /// All files that were read: the scene file itself, and the meshes and the script that it names. A recording replaces
  /// none of them.
  std::vector<std::string> files{};
  UpAxis up = UpAxis::z;  ///< as the file says; for programs that display the scene
};

/// Reads one mesh file with a unit of `unit_in_m` (m): load_mesh, or load_mesh_isolated for files of unknown origin.
using MeshLoader = std::function<TriangleMesh(const std::string& path, double unit_in_m)>;

/// Options of load_scene().
struct SceneOptions {
  std::string hold;         ///< name of the part to hold, instead of the file's; empty: the file's
  bool held_needed = true;  ///< false: also reads a file that holds no part
  /// Called before the first mesh file is read and after each, with the number of files read and of all. One call at a
  /// time; empty: no calls.
  std::function<void(std::size_t done, std::size_t total)> progress;
  MeshLoader load = load_mesh;  ///< function that reads the meshes; several threads call it at once
};

/// Reads a scene file (TOML, see docs/scene-file.md) and the meshes that it names. Parts with the same file and unit
/// share one mesh. Paths in the file are relative to its folder. Without a script in the file, the hand stays where the
/// held part starts. Throws Error `file:line: table.key: reason` for an unknown key, a wrong type, a missing file, an
/// impossible value, or a mesh that cannot be used.
SceneFile load_scene(const std::string& path, const SceneOptions& options = {});

}  // namespace tegotae
