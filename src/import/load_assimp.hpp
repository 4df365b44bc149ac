#pragma once

#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <string>
#include <vector>

#include "import/file_check.hpp"
#include "import/part_file.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

Matrix34 transform_of(const aiMatrix4x4& m);

/// Reads a plain file, all faces triangles. The scene belongs to `importer`. `materials`: also the files of materials
/// that it names, for their colors; no triangle depends on them.
const aiScene& read_scene(Assimp::Importer& importer, const std::string& path, const PlainMesh& plain, bool materials);

/// The triangles of a mesh, without its points and lines.
TriangleMesh triangles_of(const aiMesh& from);

}  // namespace tegotae
