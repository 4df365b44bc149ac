#pragma once

#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <string>
#include <vector>

#include "import/part_file.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

Matrix34 transform_of(const aiMatrix4x4& m);

/// Checks and reads the mesh file `path`, all faces triangles. The scene belongs to `importer`; `notes` gets what of
/// the file is not read.
const aiScene& read_scene(Assimp::Importer& importer, const std::string& path, std::vector<std::string>& notes);

/// The triangles of a mesh, without its points and lines.
TriangleMesh triangles_of(const aiMesh& from);

}  // namespace tegotae
