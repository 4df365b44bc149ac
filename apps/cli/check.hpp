#pragma once

#include <string>
#include <vector>

#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae::apps {

/// What `check` is asked.
struct CheckOptions {
  std::vector<std::string> files;
  bool clash = false;  ///< list the pairs of parts that clash, and nothing else
  double within = 0;   ///< m: also those that are apart by up to this
  MeshLoader load;     ///< reads the meshes
};

/// Prints a report on each mesh or scene file. A file that cannot be used is one line on stderr; returns the exit code.
int check_files(const CheckOptions& options);

}  // namespace tegotae::apps
