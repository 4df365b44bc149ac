#include "tegotae/import/load.hpp"

#include <cmath>
#include <utility>

#include "import/load_assimp.hpp"
#include "import/load_cached.hpp"
#include "import/load_triangles.hpp"
#include "import/reading.hpp"
#include "import/usable.hpp"
#include "import/utf8.hpp"

namespace tegotae {
namespace {

void append(const aiScene& scene, const aiNode& node, const Matrix34& parent, double unit, TriangleMesh& to) {
  const Matrix34 X = product(parent, transform_of(node.mTransformation));
  for (unsigned m = 0; m < node.mNumMeshes; ++m) append(triangles_of(*scene.mMeshes[node.mMeshes[m]]), X, unit, to);
  for (unsigned c = 0; c < node.mNumChildren; ++c) append(scene, *node.mChildren[c], X, unit, to);
}

TriangleMesh import(const std::string& path, double unit) {
  TriangleMesh mesh;
  mesh.name = path;
  if (is_part_file(path)) {
    const PartFile file = read_part_file(path);
    for (const std::string& note : file.notes) mesh.notes.push_back(printable(note));
    for (const PartFile::Placed& part : file.parts) append(file.meshes[part.mesh], part.X, unit, mesh);
    return mesh;
  }
  const PlainMesh plain = plain_mesh(path);
  mesh.notes = plain.notes;
  if (auto triangles = triangles_of(plain)) {
    mesh.vertices = std::move(triangles->vertices);
    mesh.triangles = std::move(triangles->triangles);
    for (Vec3& p : mesh.vertices) p = unit * (p + Vec3::Zero());  // as append() does it: there is no -0
    return mesh;
  }
  Assimp::Importer importer;
  const aiScene& scene = read_scene(importer, path, plain, false);
  append(scene, *scene.mRootNode, Matrix34::Identity(), unit, mesh);
  return mesh;
}

}  // namespace

double unit_length(const std::string& unit) {
  if (unit == "m") return 1.0;
  if (unit == "cm") return 1e-2;
  if (unit == "mm") return 1e-3;
  if (unit == "um") return 1e-6;
  if (unit == "in") return 0.0254;
  throw Error("unknown unit \"" + unit + "\" (known: m, cm, mm, um, in)");
}

TriangleMesh load_mesh(const std::string& path, double unit_in_m) {
  if (!(unit_in_m > 0) || !std::isfinite(unit_in_m)) throw Error(path + ": the unit's length must be positive");
  return load_cached(path, unit_in_m, [&] {
    return reading(path, [&] {
      const TriangleMesh mesh = import(path, unit_in_m);
      require_usable(mesh);
      TriangleMesh welded = weld(mesh);
      require_area(welded);
      return welded;
    });
  });
}

}  // namespace tegotae
