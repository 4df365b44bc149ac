#pragma once

#include <string>
#include <string_view>

namespace tegotae {

/// Walks through the bytes of an OFF file: throws Error when it is no text OFF file, is cut, names a vertex that does
/// not exist, or has faces or lines that assimp 5.2 does not read as they are.
void check_off(const std::string& path, std::string_view bytes);

}  // namespace tegotae
