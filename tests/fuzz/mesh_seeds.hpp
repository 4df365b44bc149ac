#pragma once

#include <string>
#include <vector>

#include "fuzz/fuzz.hpp"

namespace tegotae {

/// Small files of the format with this extension: stl, obj, ply, off, gltf, glb or 3mf.
std::vector<Seed> mesh_seeds(const std::string& extension);

/// The file that an input stands for: itself; of 3MF, unless it is an archive, one with it as the model. An archive
/// tells a checksum, which no mutation of the model in it would match.
std::string mesh_file(const std::string& extension, const std::string& bytes);

}  // namespace tegotae
