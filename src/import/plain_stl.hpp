#pragma once

#include <string>

namespace tegotae {

/// An STL file as assimp 5.2 reads it without fail. Binary: without bytes behind the last facet. Text: small letters,
/// no byte order mark, names of one word, no normals (nobody uses them, and those of slivers are written in many ways).
/// Throws Error when the file is cut short or damaged.
std::string plain_stl(const std::string& path, std::string file);

}  // namespace tegotae
