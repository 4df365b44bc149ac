#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tegotae {

/// What the last row of a matrix may miss 0 0 0 1 by.
constexpr double kRoundedRow = 1e-4;

/// A glTF file whose references were checked.
struct CheckedGltf {
  std::string json;                ///< what is left by keep_shape(), written anew: no two readers read it differently
  std::string_view chunk;          ///< the binary chunk of a GLB file; into its bytes
  std::vector<std::string> notes;  ///< what the file uses and is not read, a line each
};

/// Walks through a glTF or GLB file: throws Error when it is cut short, names a buffer, view, accessor, mesh or node
/// that does not exist or lies past the end of another and that a shape or place is made of, has nodes that are no
/// tree, or requires an extension that is not read.
CheckedGltf check_gltf(const std::string& path, std::string_view bytes);

}  // namespace tegotae
