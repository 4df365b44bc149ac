#pragma once

#include <string>

namespace tegotae {

/// Looks through the bytes of the mesh file `path` for what assimp 5.2 passes over in silence (indices out of range in
/// OFF and PLY, cut text files) or chokes on (counts that the file has no room for). Throws Error with the file and the
/// reason; returns if nothing speaks against reading it.
void check_mesh_file(const std::string& path);

}  // namespace tegotae
