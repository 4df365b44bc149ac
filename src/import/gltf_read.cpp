#include "import/gltf_read.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "import/file_check.hpp"
#include "import/gltf_data.hpp"
#include "import/made_up_name.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

// More are made to do harm: a few bytes can ask for any number of instances.
constexpr std::size_t kMaxParts = 1'000'000;

double srgb(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

/// glTF's colors are linear.
std::optional<Color> color_of(const cgltf_material* material) {
  if (material == nullptr) return std::nullopt;
  const cgltf_float* c = material->pbr_metallic_roughness.base_color_factor;
  if (!material->has_pbr_metallic_roughness) {
    if (!material->has_pbr_specular_glossiness) return Color{1, 1, 1, 1};
    c = material->pbr_specular_glossiness.diffuse_factor;
  }
  for (int k = 0; k < 4; ++k)
    if (!std::isfinite(c[k])) return std::nullopt;
  return Color{srgb(c[0]), srgb(c[1]), srgb(c[2]), std::clamp(double{c[3]}, 0.0, 1.0)};
}

std::string text_of(const char* name) {
  return name == nullptr ? "" : name;
}

/// The node's; where a program made that up, the mesh's.
std::string name_of(const cgltf_node& node) {
  const std::string own = text_of(node.name), mesh = text_of(node.mesh->name);
  const auto said = [](const std::string& name) { return !is_made_up(name, {"node", "object", "mesh", "group"}); };
  return said(own) || (!said(mesh) && !own.empty()) ? own : mesh;
}

class GltfReader {
 public:
  GltfReader(const std::string& path, const cgltf_data& data) : path_(path), data_(data) {
    file_.unit = "m";
    file_.up = UpAxis::y;
  }

  PartFile read() {
    if (data_.animations_count > 0)
      file_.notes.push_back(
          "animations are not read: parts stand where the nodes are; apply the pose that is meant and export anew");
    std::vector<std::string> groups;
    const cgltf_scene* scene = data_.scene != nullptr ? data_.scene : data_.scenes_count > 0 ? data_.scenes : nullptr;
    if (scene != nullptr) {
      for (std::size_t i = 0; i < scene->nodes_count; ++i) add(*scene->nodes[i], Matrix34::Identity(), groups);
    } else {
      for (std::size_t i = 0; i < data_.nodes_count; ++i)
        if (data_.nodes[i].parent == nullptr) add(data_.nodes[i], Matrix34::Identity(), groups);
    }
    note_unread();
    return std::move(file_);
  }

 private:
  void add(const cgltf_node& node, const Matrix34& parent, std::vector<std::string>& groups) {
    const Matrix34 X = product(parent, local_map(node));
    if (node.mesh != nullptr) shown_.insert(&node);
    if (node.mesh != nullptr) add_parts(node, X, groups);
    groups.push_back(text_of(node.name));
    for (std::size_t c = 0; c < node.children_count; ++c) add(*node.children[c], X, groups);
    groups.pop_back();
  }

  void note_unread() {
    std::size_t other = 0;
    for (std::size_t i = 0; i < data_.nodes_count; ++i)
      other += data_.nodes[i].mesh != nullptr && shown_.count(&data_.nodes[i]) == 0;
    if (other > 0)
      file_.notes.push_back("not in the scene that is read: nodes with meshes, " + std::to_string(other) +
                            " of them: left out; add them to that scene if they are parts");
    if (off_weights_ > 0)
      file_.notes.push_back("the weights of " + std::to_string(off_weights_) +
                            " vertices on their joints do not add up to one: taken as shares of their sum; normalize "
                            "them if the shape is not as it should be");
    if (!left_over_.empty())
      file_.notes.push_back("the last corners of " + std::to_string(left_over_.size()) +
                            (left_over_.size() == 1 ? " list" : " lists") +
                            " of triangles are too few for a triangle: left out; export anew if there is a hole");
  }

  void add_parts(const cgltf_node& node, const Matrix34& X, const std::vector<std::string>& groups) {
    PartFile::Placed part;
    part.name = name_of(node);
    part.path = groups;
    part.mesh = mesh_of(node);
    const cgltf_primitive* largest = nullptr;
    std::size_t most = 0;
    for (std::size_t p = 0; p < node.mesh->primitives_count; ++p) {
      if (largest != nullptr && faces_[node.mesh][p] <= most) continue;
      largest = &node.mesh->primitives[p];
      most = faces_[node.mesh][p];
    }
    if (largest != nullptr) part.color = color_of(largest->material);
    // A skin tells the scene's coordinates; the format wants the node's own place ignored.
    const Matrix34 own = node.skin != nullptr ? Matrix34(Matrix34::Identity()) : X;
    for (const Matrix34& instance : instances_of(node)) {
      part.X = product(own, instance);
      file_.parts.push_back(part);
      if (file_.parts.size() > kMaxParts) throw Error(path_ + ": more than a million parts");
    }
  }

  /// EXT_mesh_gpu_instancing: one map for each instance; without it the identity.
  std::vector<Matrix34> instances_of(const cgltf_node& node) const {
    if (!node.has_mesh_gpu_instancing) return {Matrix34::Identity()};
    const cgltf_mesh_gpu_instancing& all = node.mesh_gpu_instancing;
    const std::string where = path_ + ": the instances of node " + std::to_string(&node - data_.nodes);
    std::vector<cgltf_node> nodes;
    for (std::size_t a = 0; a < all.attributes_count; ++a) {
      const cgltf_accessor& accessor = *all.attributes[a].data;
      const std::string name = text_of(all.attributes[a].name);
      const std::size_t components = name == "ROTATION" ? 4 : 3;
      if (name != "TRANSLATION" && name != "ROTATION" && name != "SCALE") continue;  // instances' colors and the like
      if (accessor.count > kMaxParts) throw Error(where + ": more than a million");
      const std::vector<double> x = numbers_of(where, accessor, components);
      if (nodes.empty()) nodes.resize(accessor.count);
      if (nodes.size() != accessor.count) throw Error(where + ": damaged: their attributes differ in number");
      for (std::size_t i = 0; i < x.size(); ++i) {
        cgltf_node& of = nodes[i / components];
        (name == "ROTATION" ? of.has_rotation : name == "SCALE" ? of.has_scale : of.has_translation) = 1;
        (name == "ROTATION" ? of.rotation
         : name == "SCALE"  ? of.scale
                            : of.translation)[i % components] = static_cast<float>(x[i]);
      }
    }
    if (nodes.empty()) throw Error(where + ": damaged: they have no places");
    std::vector<Matrix34> maps;
    for (const cgltf_node& of : nodes) maps.push_back(local_map(of));
    return maps;
  }

  /// Index of the mesh of `node` as its morph weights and its skin pose it.
  std::size_t mesh_of(const cgltf_node& node) {
    const cgltf_mesh& mesh = *node.mesh;
    std::vector<float> weights(mesh.weights, mesh.weights + mesh.weights_count);
    if (node.weights_count > 0) weights.assign(node.weights, node.weights + node.weights_count);
    const auto [known, fresh] = known_.emplace(std::make_tuple(&mesh, node.skin, weights), file_.meshes.size());
    if (!fresh) return known->second;
    TriangleMesh out;
    out.name = mesh.name != nullptr ? mesh.name : text_of(node.name);
    std::vector<std::size_t>& faces = faces_[&mesh];
    faces.clear();
    for (std::size_t p = 0; p < mesh.primitives_count; ++p) {
      TriangleMesh part;
      const std::string where = path_ + ": mesh " + std::to_string(&mesh - data_.meshes) + ", primitive " +
                                std::to_string(p) + " (node " + std::to_string(&node - data_.nodes) + ")";
      std::tie(part.vertices, part.triangles) = posed(where, node, mesh.primitives[p], weights);
      faces.push_back(part.triangles.size());
      append(part, Matrix34::Identity(), 1, out);
    }
    file_.meshes.push_back(std::move(out));
    return known->second;
  }

  /// `where`: the file and the primitive, as errors begin.
  std::pair<std::vector<Vec3>, std::vector<std::array<std::uint32_t, 3>>> posed(const std::string& where,
                                                                                const cgltf_node& node,
                                                                                const cgltf_primitive& primitive,
                                                                                const std::vector<float>& weights) {
    if (primitive.has_draco_mesh_compression) {
      if (primitive.targets_count > 0 || node.skin != nullptr)
        throw Error(where + ": a mesh compressed by Draco with a skin or morph targets is not read");
      GltfTriangles plain = draco_triangles_of(where, data_, primitive);
      return {std::move(plain.points), std::move(plain.triangles)};
    }
    GltfTriangles plain = triangles_of(where, primitive);
    if (plain.left_over) left_over_.insert(&primitive);
    for (std::size_t t = 0; t < primitive.targets_count && t < weights.size(); ++t)
      if (weights[t] != 0) morph(where, primitive.targets[t], weights[t], plain.points);
    if (node.skin != nullptr && !plain.triangles.empty())
      plain.points = skinned(where, node, primitive, plain.points, off_weights_);
    return {std::move(plain.points), std::move(plain.triangles)};
  }

  static void morph(const std::string& where, const cgltf_morph_target& target, double weight,
                    std::vector<Vec3>& points) {
    for (std::size_t a = 0; a < target.attributes_count; ++a) {
      if (target.attributes[a].type != cgltf_attribute_type_position) continue;
      const std::vector<Vec3> shift = points_of(where, *target.attributes[a].data);
      if (shift.size() != points.size())
        throw Error(where + ": damaged: a morph target and its mesh differ in their number of vertices");
      for (std::size_t i = 0; i < points.size(); ++i) points[i] += weight * shift[i];
    }
  }

  const std::string& path_;
  const cgltf_data& data_;
  std::map<std::tuple<const cgltf_mesh*, const cgltf_skin*, std::vector<float>>, std::size_t> known_;
  std::map<const cgltf_mesh*, std::vector<std::size_t>> faces_;  // of each primitive
  std::set<const cgltf_node*> shown_;                            // of those with meshes
  std::set<const cgltf_primitive*> left_over_;                   // with corners that make no triangle
  std::size_t off_weights_ = 0;                                  // vertices whose weights do not add up to one
  PartFile file_;
};

}  // namespace

PartFile read_gltf(const std::string& path) {
  const std::string bytes = read_mesh_bytes(path);
  const CheckedGltf checked = check_gltf(path, bytes);
  const GltfData data = parse_gltf(path, checked);
  PartFile file = GltfReader(path, *data).read();
  file.notes.insert(file.notes.end(), checked.notes.begin(), checked.notes.end());
  return file;
}

}  // namespace tegotae
