#pragma once

#include <string>
#include <vector>

#include "study/study.hpp"
#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae::study {

/// Writes the scene `file` as the case `c` has it into `folder`: scene.toml, and the meshes of the parts whose size the
/// case has changed. Returns the path of the scene file. Throws Error, and before it writes anything where one of them
/// is one of `inputs`, all that the study reads.
std::string write_case_scene(const SceneFile& file, const Case& c, const std::string& folder,
                             const std::vector<std::string>& inputs);

}  // namespace tegotae::study
