#pragma once

#include <functional>
#include <string>

#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae::view {

/// Makes the report (HTML) on a run of a scene by a stylus script (CSV).
using ScriptReview = std::function<std::string(SceneFile file, const std::string& script)>;

}  // namespace tegotae::view
