#pragma once

#include <string>

#include "tegotae/mesh/triangle_mesh.hpp"
#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae::python {

/// What reads mesh files: in this process for files that are trusted, otherwise in one of their own. Called with the
/// GIL held, and what it returns without.
MeshLoader mesh_loader(bool trusted);

}  // namespace tegotae::python
