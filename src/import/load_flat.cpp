#include <assimp/material.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "import/load_assimp.hpp"
#include "import/read_parts.hpp"
#include "import/usable.hpp"
#include "mesh/components.hpp"
#include "tegotae/import/load.hpp"

namespace tegotae {
namespace {

std::optional<Color> color_of(const aiScene& scene, const aiMesh& mesh) {
  if (mesh.mMaterialIndex >= scene.mNumMaterials) return std::nullopt;
  // For meshes without a material assimp adds one, known by its name.
  const aiMaterial& material = *scene.mMaterials[mesh.mMaterialIndex];
  aiString name;
  if (material.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS && std::string(name.C_Str()) == AI_DEFAULT_MATERIAL_NAME)
    return std::nullopt;
  aiColor4D c;
  if (material.Get(AI_MATKEY_BASE_COLOR, c) != aiReturn_SUCCESS &&
      material.Get(AI_MATKEY_COLOR_DIFFUSE, c) != aiReturn_SUCCESS)
    return std::nullopt;
  const Color given = {double{c.r}, double{c.g}, double{c.b}, double{c.a}};
  Color color;
  for (int k = 0; k < 4; ++k) {
    if (!std::isfinite(given[k])) return std::nullopt;
    color[k] = std::clamp(given[k], 0.0, 1.0);
  }
  return color;
}

/// Where the faces of the groups of a flat file begin.
struct Group {
  std::uint32_t first_face;
  std::string name;
  std::optional<Color> color;
};

void append_groups(const aiScene& scene, const aiNode& node, const Matrix34& parent, double unit, TriangleMesh& to,
                   std::vector<Group>& groups) {
  const Matrix34 X = product(parent, transform_of(node.mTransformation));
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[m]];
    groups.push_back({static_cast<std::uint32_t>(to.triangles.size()), node.mName.C_Str(), color_of(scene, mesh)});
    append(triangles_of(mesh), X, unit, to);
  }
  for (unsigned c = 0; c < node.mNumChildren; ++c) append_groups(scene, *node.mChildren[c], X, unit, to, groups);
}

/// One part; or, split, one for every piece, called like the group of its first face.
Assembly read_pieces(const std::string& path, const aiScene& scene, const AssemblyOptions& options) {
  Assembly assembly;
  assembly.unit = options.unit.value_or("m");
  const std::string stem = std::filesystem::path(path).stem().string();
  TriangleMesh mesh;
  mesh.name = path;
  std::vector<Group> groups;
  append_groups(scene, *scene.mRootNode, Matrix34::Identity(), unit_length(assembly.unit), mesh, groups);
  const TriangleMesh welded = usable(std::move(mesh), path, stem);
  std::vector<std::uint32_t> first_face = {0};
  std::vector<TriangleMesh> pieces;
  if (options.split)
    pieces = split(welded, first_face);
  else
    pieces.push_back(welded);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto after = std::upper_bound(groups.begin(), groups.end(), first_face[i],
                                        [](std::uint32_t f, const Group& g) { return f < g.first_face; });
    const Group& group = *std::prev(after);
    AssemblyPart part;
    part.name = pieces.size() > 1 && !group.name.empty() ? group.name : stem;
    part.color = group.color;
    part.shape = i;
    pieces[i].name = part.name;
    assembly.shapes.push_back(std::make_shared<const TriangleMesh>(std::move(pieces[i])));
    assembly.parts.push_back(std::move(part));
  }
  return assembly;
}

}  // namespace

Assembly read_flat(const std::string& path, const AssemblyOptions& options) {
  if (options.progress) options.progress("reading the file", 0, 0);
  Assimp::Importer importer;
  PlainMesh plain = plain_mesh(path);
  Assembly assembly = read_pieces(path, read_scene(importer, path, plain, true), options);
  assembly.notes = std::move(plain.notes);
  return assembly;
}

}  // namespace tegotae
