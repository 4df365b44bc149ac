#include "mesh/load_assimp.hpp"

#include <assimp/postprocess.h>

#include <algorithm>
#include <limits>

#include "mesh/file_check.hpp"
#include "mesh/load_files.hpp"
#include "mesh/precision.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

/// Coordinates beyond this (m) are taken for a damaged file or a wrong unit.
constexpr double kLargestCoordinate = 1e6;

/// assimp cuts a polygon of n corners into triangles in about n^2 * 1e-8 s: at most ten seconds for a file.
constexpr double kMostPolygonWork = 1e9;

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
  if (work > kMostPolygonWork) {
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

Matrix34 product(const Matrix34& a, const Matrix34& b) {
  Matrix34 c = a.leftCols<3>() * b;
  c.col(3) += a.col(3);
  return c;
}

const aiScene& read_scene(Assimp::Importer& importer, const std::string& path) {
  check_mesh_file(path);
  importer.SetIOHandler(new MeshFolder(path));  // which the importer deletes
  const aiScene* scene = importer.ReadFile(path, 0);
  if (scene == nullptr) throw Error(path + ": " + importer.GetErrorString());
  require_valid_indices(*scene, path);
  require_small_polygons(*scene, path);
  unmark_empty_polygons(*scene);
  scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  if (scene == nullptr || scene->mRootNode == nullptr) throw Error(path + ": " + importer.GetErrorString());
  return *scene;
}

void append(const aiMesh& from, const Matrix34& X, double unit, TriangleMesh& to) {
  const std::size_t base = to.vertices.size();
  // Indices are 32 bits wide, and so are half-edges (3 per triangle).
  if (base + from.mNumVertices > std::numeric_limits<std::uint32_t>::max() / 4 ||
      to.triangles.size() + from.mNumFaces > std::numeric_limits<std::uint32_t>::max() / 4) {
    throw Error(to.name + ": too large: more than a billion vertices or triangles");
  }
  to.vertices.reserve(base + from.mNumVertices);
  for (unsigned v = 0; v < from.mNumVertices; ++v) {
    const Vec3 p(from.mVertices[v].x, from.mVertices[v].y, from.mVertices[v].z);
    to.vertices.push_back(unit * (X.leftCols<3>() * p + X.col(3)));
  }
  const bool mirrored = X.leftCols<3>().determinant() < 0;  // turns faces inside out
  for (unsigned f = 0; f < from.mNumFaces; ++f) {
    if (from.mFaces[f].mNumIndices != 3) continue;  // points and lines
    const unsigned* i = from.mFaces[f].mIndices;
    const auto at = [base](unsigned k) { return static_cast<std::uint32_t>(base + k); };
    to.triangles.push_back(mirrored ? std::array<std::uint32_t, 3>{at(i[0]), at(i[2]), at(i[1])}
                                    : std::array<std::uint32_t, 3>{at(i[0]), at(i[1]), at(i[2])});
  }
}

void require_usable(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) throw Error(mesh.name + ": no triangles");
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      const Vec3& p = mesh.vertices[v];
      if (!p.allFinite()) throw Error(mesh.name + ": a coordinate is not a finite number");
      if (p.cwiseAbs().maxCoeff() > kLargestCoordinate) {
        throw Error(mesh.name + ": a coordinate lies beyond 1000 km: damaged, or a wrong unit");
      }
    }
  }
}

void require_area(const TriangleMesh& welded) {
  const double step = rounding_step(welded);
  for (const auto& t : welded.triangles) {
    if (!is_degenerate(welded, t, step)) return;
  }
  throw Error(welded.name + ": no triangle has an area");
}

}  // namespace tegotae
