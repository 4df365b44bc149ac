#pragma once

#include <string>

#include "tegotae/import/assembly.hpp"

namespace tegotae {

/// Readers of one kind of file each. Shapes come welded; names may repeat or be empty, shapes may lie anywhere.
Assembly read_tree(const std::string& path,
                   const AssemblyOptions& options);  ///< files of placed meshes (part_file.hpp)
Assembly read_flat(const std::string& path, const AssemblyOptions& options);  ///< STL, OBJ, PLY, OFF
Assembly read_step(const std::string& path, const AssemblyOptions& options);

/// Whether the bytes of `path` begin like a STEP file, or its name ends like one's.
bool is_step(const std::string& path);
/// The bytes of the STEP file `path`. Throws Error unless it is whole and of a known schema.
std::string check_step(const std::string& path);

}  // namespace tegotae
