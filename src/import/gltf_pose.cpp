// Where the nodes of a glTF file are, and where skins put their vertices.
#include <cmath>

#include "import/gltf_data.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

/// A joint's map from the mesh to the scene. Without inverse bind matrices they are the identity.
std::vector<Matrix34> joint_maps(const std::string& path, const cgltf_skin& skin) {
  std::vector<Matrix34> maps;
  for (std::size_t j = 0; j < skin.joints_count; ++j) maps.push_back(world_map(*skin.joints[j]));
  if (skin.inverse_bind_matrices == nullptr) return maps;
  const std::vector<double> m = numbers_of(path, *skin.inverse_bind_matrices, 16);
  if (m.size() < 16 * maps.size()) throw Error(path + ": damaged: a skin has fewer inverse bind matrices than joints");
  for (std::size_t j = 0; j < maps.size(); ++j) {
    const Eigen::Map<const Eigen::Matrix4d> bind(&m[16 * j]);
    if (!((bind.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() <= kRoundedRow))
      throw Error(path + ": damaged: an inverse bind matrix is not a pose: its last row is not 0 0 0 1");
    maps[j] = product(maps[j], bind.topRows<3>());
  }
  return maps;
}

}  // namespace

Matrix34 local_map(const cgltf_node& node) {
  Matrix34 X = Matrix34::Identity();
  if (node.has_matrix) {
    const Eigen::Matrix4d m = Eigen::Map<const Eigen::Matrix4f>(node.matrix).cast<double>();
    return m.topRows<3>();
  }
  if (node.has_rotation) {
    const auto* q = node.rotation;
    const Quat turn(q[3], q[0], q[1], q[2]);
    if (turn.norm() > 0) X.leftCols<3>() = turn.normalized().toRotationMatrix();
  }
  if (node.has_scale) X.leftCols<3>() *= Eigen::Map<const Eigen::Vector3f>(node.scale).cast<double>().asDiagonal();
  if (node.has_translation) X.col(3) = Eigen::Map<const Eigen::Vector3f>(node.translation).cast<double>();
  return X;
}

Matrix34 world_map(const cgltf_node& node) {
  Matrix34 X = local_map(node);
  for (const cgltf_node* n = node.parent; n != nullptr; n = n->parent) X = product(local_map(*n), X);
  return X;
}

std::vector<Vec3> skinned(const std::string& path, const cgltf_node& node, const cgltf_primitive& primitive,
                          const std::vector<Vec3>& points, std::size_t& off) {
  constexpr double kRounded = 1e-2;  // what weights of bytes may miss one by
  const std::vector<Matrix34> maps = joint_maps(path, *node.skin);
  std::vector<Vec3> moved(points.size(), Vec3::Zero());
  std::vector<double> sums(points.size(), 0);
  bool has_set = false;
  for (int set = 0;; ++set) {  // sets of four joints each
    const cgltf_accessor* joints = cgltf_find_accessor(&primitive, cgltf_attribute_type_joints, set);
    const cgltf_accessor* weights = cgltf_find_accessor(&primitive, cgltf_attribute_type_weights, set);
    if (joints == nullptr || weights == nullptr) break;
    has_set = true;
    const std::vector<double> w = numbers_of(path, *weights, 4), of = numbers_of(path, *joints, 4);
    if (w.size() != 4 * points.size() || of.size() != w.size())
      throw Error(path + ": damaged: a skinned mesh does not have one set of joints and weights for each vertex");
    for (std::size_t i = 0; i < w.size(); ++i) {
      if (w[i] == 0) continue;
      if (!(of[i] >= 0 && of[i] < static_cast<double>(maps.size())))
        throw Error(path + ": index out of range: a vertex names a joint that its skin does not have");
      const Matrix34& X = maps[static_cast<std::size_t>(of[i])];
      sums[i / 4] += w[i];
      moved[i / 4] += w[i] * (X.leftCols<3>() * points[i / 4] + X.col(3));
    }
  }
  if (!has_set) throw Error(path + ": damaged: a skinned mesh has no joints and weights");
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (!(sums[i] > 0)) throw Error(path + ": damaged: a vertex of a skinned mesh hangs on no joint");
    off += std::abs(sums[i] - 1) > kRounded;
    moved[i] /= sums[i];
  }
  return moved;
}

}  // namespace tegotae
