#pragma once

#include <string>
#include <vector>

#include "tegotae/sim/scene_file.hpp"

namespace tegotae::apps {

/// Prints a report on each mesh or scene file. A file that cannot be used is one line on stderr; returns the exit code.
int check_files(const std::vector<std::string>& files, const MeshLoader& load);

}  // namespace tegotae::apps
