#pragma once

#include <string>
#include <string_view>

namespace tegotae {

/// Walks through the bytes of a PLY file: throws Error when a list or element reaches past the end or a face names a
/// vertex that does not exist. assimp 5.2 checks neither.
void check_ply(const std::string& path, std::string_view bytes);

}  // namespace tegotae
