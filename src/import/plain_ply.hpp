#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tegotae {

/// The vertices, faces and triangle strips of a PLY file as a PLY file of faces alone, binary and little-endian: what
/// assimp 5.2 reads without fail. Elements and properties that are not shape are skipped. Throws Error when the file is
/// cut short or damaged, has no faces, or when a face names a vertex that does not exist. `notes` gets what is not
/// read.
std::string plain_ply(const std::string& path, std::string_view bytes, std::vector<std::string>& notes);

}  // namespace tegotae
