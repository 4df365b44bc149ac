#pragma once

#include <string>

#include "study/study.hpp"

namespace tegotae::study {

/// Reads a study file (TOML, see docs/study.md); paths in it are relative to its folder. Throws Error
/// `file:line: table.key: reason`.
Study read_study(const std::string& path);

}  // namespace tegotae::study
