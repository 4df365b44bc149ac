#pragma once

#include "import/part_file.hpp"

namespace tegotae {

/// Reads a 3MF file (core specification, parts in several files, colors by base materials): the objects that its build
/// places. Throws Error where the file requires an extension that is not read.
PartFile read_3mf(const std::string& path);

}  // namespace tegotae
