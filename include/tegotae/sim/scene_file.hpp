#pragma once

#include <functional>
#include <string>

#include "tegotae/core/export.hpp"
#include "tegotae/device/script.hpp"
#include "tegotae/device/simulated_device.hpp"
#include "tegotae/mesh/load.hpp"
#include "tegotae/sim/scene.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// What a scene file says: the scene, the pen, and what moves it.
struct SceneFile {
  std::string path;
  Scene scene;
  SimulatedDeviceSettings device;
  StylusScript script;  ///< what the operator's hand does
};

/// Reads one mesh file, whose unit has this length in m: load_mesh, or load_mesh_isolated for files of unknown origin.
using MeshLoader = std::function<TriangleMesh(const std::string& path, double unit_in_m)>;

/// Reads a scene file (TOML, see docs/scene-file.md) and the meshes it names; parts with the same file and unit share
/// one mesh. Paths in the file are relative to its folder. Throws Error `file:line: table.key: reason` at an unknown
/// key, a wrong type, a missing file, an impossible value, or a mesh that cannot be used.
SceneFile load_scene(const std::string& path, const MeshLoader& load = load_mesh);

}  // namespace tegotae
