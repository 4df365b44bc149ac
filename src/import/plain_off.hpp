#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tegotae {

/// The vertices and faces of a text OFF file as a PLY file. Throws Error when it is not a text OFF file of three
/// dimensions, is cut, has no faces, or names a vertex that does not exist. `notes` gets what is not read.
std::string plain_off(const std::string& path, std::string_view bytes, std::vector<std::string>& notes);

}  // namespace tegotae
