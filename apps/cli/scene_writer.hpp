#pragma once

#include <functional>
#include <string>

#include "tegotae/import/assembly.hpp"

namespace tegotae::apps {

/// Writes `assembly`, as read from the file `source`, into `folder`: scene.toml, and under meshes/ one PLY file for
/// each shape. The part called `hold` is held (none when it is empty). The scene file comes last, under its name only
/// when it is whole. Throws Error when something cannot be written, or `source` would be replaced.
void write_scene(const Assembly& assembly, const std::string& source, const std::string& folder,
                 const std::string& hold,
                 const std::function<void(const char* what, std::size_t done, std::size_t total)>& progress = {});

}  // namespace tegotae::apps
