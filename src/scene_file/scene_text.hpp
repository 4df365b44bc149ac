#pragma once

#include <string>

#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae {

/// The text of a scene file for `now`, a scene with parts of `file` in other places, some of them left out, perhaps
/// with another one held. Its paths are as seen from `folder`; everything else is as in `file`, but for the script,
/// which is for the part that `file` holds. Throws Error when `file` was not read from a file.
std::string scene_text(const SceneFile& file, const Scene& now, const std::string& folder);

/// Everything that the scene file sets, without its comments and its layout; empty when `file` was not read from one.
std::string scene_settings(const SceneFile& file);

}  // namespace tegotae
