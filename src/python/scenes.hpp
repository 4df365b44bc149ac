#pragma once

#include <nanobind/nanobind.h>

#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae::python {

/// The pen holds the part `name` instead. Throws Error that names those that there are.
void hold(Scene& scene, const std::string& name);

/// Reads the scene file `path`, a str or a path. Called with the GIL held, which is free meanwhile.
SceneFile read_scene_file(nanobind::handle path, const std::string& hold, bool trusted);

}  // namespace tegotae::python
