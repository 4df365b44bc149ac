#pragma once

#include <string>
#include <vector>

#include "fuzz/fuzz.hpp"

namespace tegotae {

/// Small files of the format with this extension: stl, obj, ply, off, gltf, glb or 3mf.
std::vector<Seed> mesh_seeds(const std::string& extension);

}  // namespace tegotae
