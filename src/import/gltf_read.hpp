#pragma once

#include "import/part_file.hpp"

namespace tegotae {

/// Reads a glTF 2.0 or GLB file: the meshes of its scene's nodes, posed by morph weights and skins, instances placed.
/// Throws Error where the file asks for something that is not read and changes shape or place.
PartFile read_gltf(const std::string& path);

}  // namespace tegotae
