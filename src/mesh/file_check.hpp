#pragma once

#include <string>

namespace tegotae {

/// Looks through the bytes of the mesh file `path` for what assimp 5.2 passes over in silence (indices out of range in
/// OFF and PLY, cut text files) or chokes on (counts that the file has no room for). Throws Error with the file and the
/// reason; returns if nothing speaks against reading it.
void check_mesh_file(const std::string& path);

/// All bytes of the regular file `path`. Throws Error with the file and the reason.
std::string read_bytes(const std::string& path);

/// The extension of `path` with its dot, in small letters.
std::string lower_extension(const std::string& path);

}  // namespace tegotae
