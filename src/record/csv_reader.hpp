#pragma once

#include <string>

#include "tegotae/record/recording.hpp"

namespace tegotae {

/// See read_recording; `text` is the whole file. Leaves the info empty.
Recording read_csv(const std::string& path, const std::string& text);

}  // namespace tegotae
