#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "import/cgltf/cgltf.h"
#include "import/gltf_check.hpp"
#include "import/part_file.hpp"

namespace tegotae {

struct FreeGltf {
  void operator()(cgltf_data* data) const { cgltf_free(data); }
};

/// A parsed glTF file; points into what it was parsed from.
using GltfData = std::unique_ptr<cgltf_data, FreeGltf>;

/// Parses the file `path`, loads its buffers and decompresses its buffer views.
GltfData parse_gltf(const std::string& path, const CheckedGltf& checked);

/// All numbers of an accessor, sparse and integer ones as what they stand for; `components` an element.
/// Throws Error when it has another number of components.
std::vector<double> numbers_of(const std::string& path, const cgltf_accessor& accessor, std::size_t components);
std::vector<Vec3> points_of(const std::string& path, const cgltf_accessor& accessor);
/// All whole numbers of an accessor of scalars, sparse or not.
std::vector<std::size_t> indices_of(const std::string& path, const cgltf_accessor& accessor);

/// Corners of a primitive's triangles and their indices; decodes Draco.
struct GltfTriangles {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  bool left_over = false;  ///< corners that are too few for one more triangle
};
GltfTriangles triangles_of(const std::string& path, const cgltf_primitive& primitive);

/// The same of a primitive compressed by KHR_draco_mesh_compression.
GltfTriangles draco_triangles_of(const std::string& path, const cgltf_data& data, const cgltf_primitive& primitive);

/// From a node to its parent, and to the scene.
Matrix34 local_map(const cgltf_node& node);
Matrix34 world_map(const cgltf_node& node);

/// The points of a primitive of `node` in the scene, moved by the node's skin; `points` are those of the mesh. A
/// vertex's weights count as shares of their sum; `off` gets the number of vertices whose sum is not about one.
std::vector<Vec3> skinned(const std::string& path, const cgltf_node& node, const cgltf_primitive& primitive,
                          const std::vector<Vec3>& points, std::size_t& off);

}  // namespace tegotae
