#pragma once

#include <string>

namespace tegotae {

/// The bytes of the mesh file `path` (STL, OBJ, PLY, OFF) in the one way of writing that assimp 5.2 reads without fail.
/// Looked through before for what assimp passes over in silence (indices out of range in OFF and PLY, cut text files)
/// or chokes on (counts that the file has no room for). Throws Error with the file and the reason.
std::string plain_mesh_bytes(const std::string& path);

/// All bytes of the file `path`; throws Error when it is empty or STEP.
std::string read_mesh_bytes(const std::string& path);

/// All bytes of the regular file `path`. Throws Error with the file and the reason.
std::string read_bytes(const std::string& path);

/// The extension of `path` with its dot, in small letters.
std::string lower_extension(const std::string& path);
/// Whether a file holds parts and is no scene, by the end of its name.
bool is_file_of_parts(const std::string& path);

}  // namespace tegotae
