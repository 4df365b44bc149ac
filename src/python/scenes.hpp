#pragma once

#include <nanobind/nanobind.h>

#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae::python {

/// Reads the scene file `path`, a str or a path. Called with the GIL held, which is free meanwhile.
SceneFile read_scene_file(nanobind::handle path, const std::string& hold, bool trusted);

}  // namespace tegotae::python
