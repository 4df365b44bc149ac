#pragma once

#include <vector>

#include "fuzz/fuzz.hpp"

namespace tegotae {

/// Files of a tetrahedron that Draco and meshoptimizer have compressed, as glTF with its data in it.
std::vector<Seed> compressed_gltf();
/// Text that JSON takes for these bytes.
std::string base64(const std::string& bytes);

}  // namespace tegotae
