#include <assimp/material.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "mesh/components.hpp"
#include "mesh/file_check.hpp"
#include "mesh/load_assimp.hpp"
#include "mesh/read_parts.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/mesh/load.hpp"

namespace tegotae {
namespace {

// Entries of two maps that differ by less are equal: they are products of a few matrices of floats.
constexpr double kMapNoise = 2e-6;

/// A map as a pose after a linear map that has no rotation in it: a scale, a shear, a mirroring of x.
struct Placement {
  Pose pose;
  Mat3 rest;
};

Placement placement_of(const Matrix34& X) {
  const Mat3 A = X.leftCols<3>();
  const Vec3 mirror(A.determinant() < 0 ? -1.0 : 1.0, 1, 1);
  const Eigen::JacobiSVD<Mat3> svd(A * mirror.asDiagonal(), Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Mat3 R = svd.matrixU() * svd.matrixV().transpose();
  Placement placement;
  placement.pose.q = Quat(R).normalized();
  placement.pose.p = X.col(3);
  placement.rest = placement.pose.q.toRotationMatrix().transpose() * A;
  if ((placement.rest - Mat3::Identity()).cwiseAbs().maxCoeff() < kMapNoise) placement.rest.setIdentity();
  return placement;
}

double srgb(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

/// `linear`: of a glTF file, whose colors are linear.
std::optional<Color> color_of(const aiScene& scene, const aiMesh& mesh, bool linear) {
  if (mesh.mMaterialIndex >= scene.mNumMaterials) return std::nullopt;
  // For meshes without a material assimp adds one: to glTF always, as the last; to others by its name.
  if (linear && mesh.mMaterialIndex + 1 == scene.mNumMaterials) return std::nullopt;
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
    color[k] = linear && k < 3 ? srgb(given[k]) : std::clamp(given[k], 0.0, 1.0);
  }
  return color;
}

/// The color of the mesh of `node` with the most faces.
std::optional<Color> color_of(const aiScene& scene, const aiNode& node, bool linear) {
  const aiMesh* largest = nullptr;
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh* mesh = scene.mMeshes[node.mMeshes[m]];
    if (largest == nullptr || mesh->mNumFaces > largest->mNumFaces) largest = mesh;
  }
  return largest == nullptr ? std::nullopt : color_of(scene, *largest, linear);
}

TriangleMesh usable(TriangleMesh mesh, const std::string& path, const std::string& name) {
  mesh.name = path + ": \"" + name + '"';
  require_usable(mesh);
  TriangleMesh welded = weld(mesh);
  require_area(welded);
  welded.name = name;
  return welded;
}

/// Walks over the nodes of a glTF file.
class TreeReader {
 public:
  TreeReader(const std::string& path, const aiScene& scene, const AssemblyOptions& options)
      : path_(path), scene_(scene), options_(options) {}

  Assembly read() {
    count(*scene_.mRootNode);
    // Of several roots assimp makes the children of one that it calls ROOT.
    std::vector<std::string> path;
    if (std::string(scene_.mRootNode->mName.C_Str()) == "ROOT" && scene_.mRootNode->mNumMeshes == 0) {
      const Matrix34 X = transform_of(scene_.mRootNode->mTransformation);
      for (unsigned c = 0; c < scene_.mRootNode->mNumChildren; ++c) add(*scene_.mRootNode->mChildren[c], X, path);
    } else {
      add(*scene_.mRootNode, Matrix34::Identity(), path);
    }
    assembly_.unit = "m";
    return std::move(assembly_);
  }

 private:
  void count(const aiNode& node) {
    total_ += node.mNumMeshes > 0;
    for (unsigned c = 0; c < node.mNumChildren; ++c) count(*node.mChildren[c]);
  }

  void add(const aiNode& node, const Matrix34& parent, std::vector<std::string>& path) {
    const Matrix34 X = product(parent, transform_of(node.mTransformation));
    if (node.mNumMeshes > 0) add_part(node, X, path);
    path.emplace_back(node.mName.C_Str());
    for (unsigned c = 0; c < node.mNumChildren; ++c) add(*node.mChildren[c], X, path);
    path.pop_back();
  }

  void add_part(const aiNode& node, const Matrix34& X, const std::vector<std::string>& path) {
    AssemblyPart part;
    part.name = node.mName.C_Str();
    part.path = path;
    const Placement placement = placement_of(X);
    part.pose = placement.pose;
    if (!find_shape(node, placement.rest, part.name, part.shape)) return;
    part.color = color_of(scene_, node, true);
    assembly_.parts.push_back(std::move(part));
    if (options_.progress) options_.progress("reading parts", ++done_, total_);
  }

  /// The shape of the meshes of `node`, mapped by `map`; false when they have no triangles.
  bool find_shape(const aiNode& node, const Mat3& map, const std::string& name, std::size_t& shape) {
    const std::vector<unsigned> meshes(node.mMeshes, node.mMeshes + node.mNumMeshes);
    for (const Known& known : known_[meshes]) {
      if ((known.map - map).cwiseAbs().maxCoeff() > kMapNoise * map.cwiseAbs().maxCoeff()) continue;
      shape = known.shape;
      return true;
    }
    TriangleMesh mesh;
    mesh.name = name;
    Matrix34 X = Matrix34::Zero();
    X.leftCols<3>() = map;
    for (const unsigned m : meshes) append(*scene_.mMeshes[m], X, 1.0, mesh);
    if (mesh.triangles.empty()) {
      assembly_.notes.push_back("\"" + name + "\" has no triangles: left out");
      return false;
    }
    shape = assembly_.shapes.size();
    known_[meshes].push_back({map, shape});
    const std::string mesh_name = scene_.mMeshes[meshes.front()]->mName.C_Str();
    assembly_.shapes.push_back(
        std::make_shared<const TriangleMesh>(usable(std::move(mesh), path_, mesh_name.empty() ? name : mesh_name)));
    return true;
  }

  struct Known {
    Mat3 map;
    std::size_t shape;
  };

  const std::string& path_;
  const aiScene& scene_;
  const AssemblyOptions& options_;
  std::map<std::vector<unsigned>, std::vector<Known>> known_;
  Assembly assembly_;
  std::size_t done_ = 0, total_ = 0;
};

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
    groups.push_back(
        {static_cast<std::uint32_t>(to.triangles.size()), node.mName.C_Str(), color_of(scene, mesh, false)});
    append(mesh, X, unit, to);
  }
  for (unsigned c = 0; c < node.mNumChildren; ++c) append_groups(scene, *node.mChildren[c], X, unit, to, groups);
}

/// One part; or, split, one for every piece, called like the group of its first face.
Assembly read_flat(const std::string& path, const aiScene& scene, const AssemblyOptions& options) {
  Assembly assembly;
  assembly.unit = options.unit;
  const std::string stem = std::filesystem::path(path).stem().string();
  TriangleMesh mesh;
  mesh.name = path;
  std::vector<Group> groups;
  append_groups(scene, *scene.mRootNode, Matrix34::Identity(), unit_length(options.unit), mesh, groups);
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

Assembly read_tree(const std::string& path, const AssemblyOptions& options) {
  if (options.progress) options.progress("reading the file", 0, 0);
  Assimp::Importer importer;
  const aiScene& scene = read_scene(importer, path);
  const std::string extension = lower_extension(path);
  if (extension == ".gltf" || extension == ".glb") return TreeReader(path, scene, options).read();
  return read_flat(path, scene, options);
}

}  // namespace tegotae
