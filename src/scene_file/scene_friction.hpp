#pragma once

#include "scene_file/toml_table.hpp"
#include "tegotae/loop/scene.hpp"

namespace tegotae {

/// Reads the table [friction] of a scene file whose parts are in `scene` already. Throws Error.
void read_friction(const TomlTable& top, Scene& scene);

}  // namespace tegotae
