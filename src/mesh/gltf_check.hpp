#pragma once

#include <string>
#include <string_view>

namespace tegotae {

/// Walks through a glTF or GLB file: throws Error when it is cut short, names a buffer, view, accessor, mesh or node
/// that does not exist or lies past the end of another, or when its nodes are no tree. assimp 5.2 follows some of
/// these.
void check_gltf(const std::string& path, std::string_view bytes);

}  // namespace tegotae
