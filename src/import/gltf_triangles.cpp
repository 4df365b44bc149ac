// The triangles of a glTF primitive: lists, strips and fans, indexed or not, plain or compressed by Draco.
#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>

#include <limits>
#include <numeric>

#include "import/gltf_data.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

/// Of a primitive of so many points; without indices all of them.
std::vector<std::size_t> indices_of(const std::string& path, const cgltf_primitive& primitive, std::size_t points) {
  if (primitive.indices == nullptr) {
    std::vector<std::size_t> all(points);
    std::iota(all.begin(), all.end(), std::size_t{0});
    return all;
  }
  std::vector<std::size_t> indices = tegotae::indices_of(path, *primitive.indices);
  for (const std::size_t i : indices)
    if (i >= points)
      throw Error(path + ": index out of range: a primitive names vertex " + std::to_string(i) + " of " +
                  std::to_string(points));
  return indices;
}

std::vector<std::array<std::uint32_t, 3>> assembled(const std::string& path, cgltf_primitive_type type,
                                                    const std::vector<std::size_t>& indices) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    triangles.push_back({static_cast<std::uint32_t>(indices[a]), static_cast<std::uint32_t>(indices[b]),
                         static_cast<std::uint32_t>(indices[c])});
  };
  const std::size_t n = indices.size();
  if (type == cgltf_primitive_type_triangles)
    for (std::size_t i = 0; i + 2 < n; i += 3) add(i, i + 1, i + 2);
  else if (type == cgltf_primitive_type_triangle_strip)
    for (std::size_t i = 0; i + 2 < n; ++i) add(i, i + 1 + i % 2, i + 2 - i % 2);
  else if (type == cgltf_primitive_type_triangle_fan)
    for (std::size_t i = 1; i + 1 < n; ++i) add(i, i + 1, 0);
  else if (type == cgltf_primitive_type_invalid)
    throw Error(path + ": damaged: a primitive has an unknown mode");
  return triangles;  // of points and lines: none
}

/// Whether some of `n` corners make no triangle.
bool has_left_over(cgltf_primitive_type type, std::size_t n) {
  if (type == cgltf_primitive_type_triangles) return n % 3 != 0;
  return (type == cgltf_primitive_type_triangle_strip || type == cgltf_primitive_type_triangle_fan) && n > 0 && n < 3;
}

const cgltf_attribute* position_of(const cgltf_attribute* attributes, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    if (attributes[i].type == cgltf_attribute_type_position) return &attributes[i];
  return nullptr;
}

/// What a component of an accessor is divided by: integers may stand for numbers from -1 or 0 to 1.
double divisor_of(const cgltf_accessor& accessor) {
  if (!accessor.normalized) return 1;
  switch (accessor.component_type) {
    case cgltf_component_type_r_8:
      return 127;
    case cgltf_component_type_r_8u:
      return 255;
    case cgltf_component_type_r_16:
      return 32767;
    case cgltf_component_type_r_16u:
      return 65535;
    default:
      return 1;
  }
}

}  // namespace

GltfTriangles triangles_of(const std::string& path, const cgltf_primitive& primitive) {
  GltfTriangles out;
  const cgltf_attribute* position = position_of(primitive.attributes, primitive.attributes_count);
  if (position == nullptr) return out;  // the format leaves such a primitive to extensions
  out.points = points_of(path, *position->data);
  if (out.points.size() > std::numeric_limits<std::uint32_t>::max() / 4)
    throw Error(path + ": too large: more than a billion vertices");
  const std::vector<std::size_t> indices = indices_of(path, primitive, out.points.size());
  out.triangles = assembled(path, primitive.type, indices);
  out.left_over = has_left_over(primitive.type, indices.size());
  return out;
}

GltfTriangles draco_triangles_of(const std::string& path, const cgltf_data& data, const cgltf_primitive& primitive) {
  const cgltf_draco_mesh_compression& from = primitive.draco_mesh_compression;
  const cgltf_attribute* position = position_of(from.attributes, from.attributes_count);
  const auto fail = [&](const std::string& why) -> Error {
    return Error(path + ": damaged: a mesh compressed by Draco " + why);
  };
  if (position == nullptr) throw fail("names no positions");
  const auto* bytes = reinterpret_cast<const char*>(cgltf_buffer_view_data(from.buffer_view));
  if (bytes == nullptr) throw fail("has no data");
  draco::DecoderBuffer buffer;
  buffer.Init(bytes, from.buffer_view->size);
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) throw fail(std::string("is not a stream of it: ") + decoded.status().error_msg());
  const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
  // What cgltf keeps as the accessor of that number is the attribute's number in the Draco stream.
  const auto id = static_cast<std::uint32_t>(cgltf_accessor_index(&data, position->data));
  const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(id);
  if (attribute == nullptr || attribute->num_components() != 3) throw fail("has no positions");
  // The stream has the bare integers; what they stand for the accessor says.
  const cgltf_attribute* declared = position_of(primitive.attributes, primitive.attributes_count);
  const double divisor = declared == nullptr || attribute->normalized() ? 1 : divisor_of(*declared->data);
  const bool share = divisor != 1 || (attribute->normalized() && draco::IsDataTypeIntegral(attribute->data_type()));
  GltfTriangles out;
  for (draco::PointIndex i(0); i < mesh->num_points(); ++i) {
    std::array<float, 3> p{};
    if (!attribute->ConvertValue<float, 3>(attribute->mapped_index(i), p.data())) throw fail("has no positions");
    out.points.emplace_back(p[0], p[1], p[2]);
    if (share) out.points.back() = (out.points.back() / divisor).cwiseMax(-1);  // -128 stands for -1 too
  }
  std::vector<std::size_t> indices;
  for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f) {
    for (const draco::PointIndex& corner : mesh->face(f)) {
      if (corner.value() >= out.points.size()) throw fail("has an index out of range");
      indices.push_back(corner.value());
    }
  }
  out.triangles = assembled(path, cgltf_primitive_type_triangles, indices);
  return out;
}

}  // namespace tegotae
