#pragma once

#include <string>

#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae::review {

/// Runs `file` in virtual time by a stylus script, the text of a CSV file, and returns the report on that run, HTML.
/// The held part begins where the script does; where it was to go is where the scene's own script ends, if that goes
/// anywhere. Takes seconds. Throws Error when the script cannot be read or the scene cannot be held.
std::string script_report(SceneFile file, const std::string& script);

}  // namespace tegotae::review
