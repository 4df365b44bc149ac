#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tegotae {

/// The vertices, faces, groups and materials of an OBJ file as an OBJ file that assimp 5.2 reads without fail: a
/// statement to a line, a vertex of three numbers, a face of plain indices. Throws Error with the line when a vertex
/// has not three numbers, a face names a vertex that does not exist, or the file stops within a line. `notes` gets
/// what is not read: free-form surfaces, statements that are not known.
std::string plain_obj(const std::string& path, std::string_view bytes, std::vector<std::string>& notes);

}  // namespace tegotae
