#include "import/load_assimp.hpp"

#include <assimp/postprocess.h>

#include <algorithm>

#include "import/load_files.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

/// assimp cuts a polygon of n corners into triangles in about n^2 * 1e-8 s: at most ten seconds for a file.
constexpr double kMaxPolygonWork = 1e9;

/// assimp passes some files' indices through unchecked, and its own later steps trust them.
void require_valid_indices(const aiScene& scene, const std::string& path) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      for (unsigned k = 0; k < mesh.mFaces[f].mNumIndices; ++k) {
        if (mesh.mFaces[f].mIndices[k] >= mesh.mNumVertices) {
          throw Error(path + ": index out of range: face " + std::to_string(f) + " names vertex " +
                      std::to_string(mesh.mFaces[f].mIndices[k]) + " of " + std::to_string(mesh.mNumVertices));
        }
      }
    }
  }
}

void require_small_polygons(const aiScene& scene, const std::string& path) {
  double work = 0;
  unsigned most = 0;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const unsigned corners = mesh.mFaces[f].mNumIndices;
      if (corners > 3) work += static_cast<double>(corners) * corners;
      most = std::max(most, corners);
    }
  }
  if (work > kMaxPolygonWork) {
    throw Error(path + ": polygons of up to " + std::to_string(most) +
                " corners would take too long to cut into triangles: export the part as triangles");
  }
}

/// A face without corners is marked as a polygon by assimp, whose triangulation then ends the program; it also does
/// when nothing is marked.
void unmark_empty_polygons(const aiScene& scene) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    aiMesh& mesh = *scene.mMeshes[m];
    aiFace* end = mesh.mFaces + mesh.mNumFaces;
    if (std::none_of(mesh.mFaces, end, [](const aiFace& f) { return f.mNumIndices > 3; }))
      mesh.mPrimitiveTypes =
          (mesh.mPrimitiveTypes & ~static_cast<unsigned>(aiPrimitiveType_POLYGON)) | aiPrimitiveType_POINT;
  }
}

}  // namespace

Matrix34 transform_of(const aiMatrix4x4& m) {
  Matrix34 t;
  t << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4;
  return t;
}

const aiScene& read_scene(Assimp::Importer& importer, const std::string& path, const PlainMesh& plain, bool materials) {
  const aiScene* scene = nullptr;
  if (plain.format == "obj") {                                            // the only format that names other files
    importer.SetIOHandler(new MeshFolder(path, plain.bytes, materials));  // which the importer deletes
    scene = importer.ReadFile(path, 0);
  } else {
    scene = importer.ReadFileFromMemory(plain.bytes.data(), plain.bytes.size(), 0, plain.format.c_str());
  }
  if (scene == nullptr) throw Error(path + ": " + importer.GetErrorString());
  require_valid_indices(*scene, path);
  require_small_polygons(*scene, path);
  unmark_empty_polygons(*scene);
  scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  if (scene == nullptr || scene->mRootNode == nullptr) throw Error(path + ": " + importer.GetErrorString());
  return *scene;
}

TriangleMesh triangles_of(const aiMesh& from) {
  TriangleMesh mesh;
  mesh.name = from.mName.C_Str();
  mesh.vertices.reserve(from.mNumVertices);
  for (unsigned v = 0; v < from.mNumVertices; ++v)
    mesh.vertices.emplace_back(from.mVertices[v].x, from.mVertices[v].y, from.mVertices[v].z);
  for (unsigned f = 0; f < from.mNumFaces; ++f) {
    const unsigned* i = from.mFaces[f].mIndices;
    if (from.mFaces[f].mNumIndices == 3) mesh.triangles.push_back({i[0], i[1], i[2]});  // else points and lines
  }
  return mesh;
}

}  // namespace tegotae
