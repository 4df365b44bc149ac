#pragma once

#include <string>
#include <string_view>

namespace tegotae {

/// The vertices and faces of a text OFF file as a PLY file. Throws Error when it is no text OFF file of three
/// dimensions, is cut, or names a vertex that does not exist.
std::string plain_off(const std::string& path, std::string_view bytes);

}  // namespace tegotae
