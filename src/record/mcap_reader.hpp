#pragma once

#include <string>

#include "tegotae/record/recording.hpp"

namespace tegotae {

/// See read_recording; `bytes` is the whole file.
Recording read_mcap(const std::string& path, const std::string& bytes);

}  // namespace tegotae
