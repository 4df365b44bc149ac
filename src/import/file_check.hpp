#pragma once

#include <string>
#include <vector>

namespace tegotae {

/// A mesh file in the one way of writing that assimp 5.2 reads without fail.
struct PlainMesh {
  std::string bytes, format;       ///< the format: obj, ply or stl
  std::vector<std::string> notes;  ///< what of the file is not read
};

/// The mesh file `path` (STL, OBJ, PLY, OFF). Looked through before for what assimp passes over in silence (indices out
/// of range, cut text files) or chokes on (counts that the file has no room for). Throws Error with the file and the
/// reason.
PlainMesh plain_mesh(const std::string& path);

/// All bytes of the file `path`; throws Error when it is empty or STEP.
std::string read_mesh_bytes(const std::string& path);

/// All bytes of the regular file `path`. Throws Error with the file and the reason.
std::string read_bytes(const std::string& path);

/// Throws Error when `path` is not there, or is a folder, a pipe or a device.
void require_file(const std::string& path);

/// The extension of `path` with its dot, in small letters.
std::string lower_extension(const std::string& path);
/// Whether a file holds parts and is not a scene, by the end of its name.
bool is_file_of_parts(const std::string& path);
/// The kinds of file that are read, for messages.
inline constexpr const char* kKindsOfFile =
    "scenes (.toml), parts (.step, .stp, .gltf, .glb, .3mf, .stl, .obj, .ply, .off) and recordings (.csv, .mcap)";

}  // namespace tegotae
