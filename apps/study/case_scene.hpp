#pragma once

#include <string>

#include "study/study.hpp"
#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae::study {

/// Writes the scene `file` as the case `c` has it into `folder`: scene.toml, and the meshes of the parts whose size the
/// case has changed. Returns the path of the scene file. Throws Error.
std::string write_case_scene(const SceneFile& file, const Case& c, const std::string& folder);

}  // namespace tegotae::study
