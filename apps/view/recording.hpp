#pragma once

#include <string>
#include <vector>

#include "tegotae/record/recorder.hpp"

namespace tegotae::view {

/// The rows of a recording (CSV as docs/programs.md says, columns in any order). A last row that was cut is left out.
/// Throws Error `file:line: reason`.
std::vector<RecordFrame> read_recording(const std::string& path);

}  // namespace tegotae::view
