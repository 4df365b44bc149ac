#include "fuzz/gltf_seeds.hpp"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include <memory>

namespace tegotae {
namespace {

constexpr float kDracoCorners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
constexpr unsigned kDracoFaces[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};

std::string draco_stream() {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(4);
  const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (std::uint32_t f = 0; f < 4; ++f)
    builder.SetAttributeValuesForFace(id, draco::FaceIndex(f), kDracoCorners[kDracoFaces[3 * f]],
                                      kDracoCorners[kDracoFaces[3 * f + 1]], kDracoCorners[kDracoFaces[3 * f + 2]]);
  const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
  draco::Encoder encoder;
  draco::EncoderBuffer packed;
  require(encoder.EncodeMeshToBuffer(*mesh, &packed).ok(), "a seed can be made");
  return {packed.data(), packed.size()};
}

std::string number(std::size_t n) {
  return std::to_string(n);
}

std::string buffer_of(const std::string& bytes) {
  return R"({"byteLength":)" + number(bytes.size()) + R"(,"uri":"data:application/octet-stream;base64,)" +
         base64(bytes) + "\"}";
}

std::string draco_gltf() {
  const std::string bytes = draco_stream();
  return R"({"asset":{"version":"2.0"},"extensionsRequired":["KHR_draco_mesh_compression"],"nodes":[{"mesh":0}],)"
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"extensions":{)"
         R"("KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}}}]}],)"
         R"("accessors":[{"componentType":5126,"count":4,"type":"VEC3"},{"componentType":5123,"count":12,)"
         R"("type":"SCALAR"}],"bufferViews":[{"buffer":0,"byteLength":)" +
         number(bytes.size()) + R"(}],"buffers":[)" + buffer_of(bytes) + "]}";
}

std::string meshopt_gltf() {
  std::string corners(meshopt_encodeVertexBufferBound(4, 12), '\0'), faces(meshopt_encodeIndexBufferBound(12, 4), '\0');
  corners.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(corners.data()), corners.size(),
                                            kDracoCorners, 4, 12));
  faces.resize(
      meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(faces.data()), faces.size(), kDracoFaces, 12));
  const auto view = [](std::size_t at, std::size_t bytes, std::size_t from, std::size_t packed, const char* more) {
    return R"({"buffer":1,"byteOffset":)" + number(at) + R"(,"byteLength":)" + number(bytes) +
           R"(,"extensions":{"EXT_meshopt_compression":{"buffer":0,"byteOffset":)" + number(from) +
           R"(,"byteLength":)" + number(packed) + more + "}}}";
  };
  return R"({"asset":{"version":"2.0"},"extensionsRequired":["EXT_meshopt_compression"],"nodes":[{"mesh":0}],)"
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
         R"({"bufferView":1,"componentType":5125,"count":12,"type":"SCALAR"}],"bufferViews":[)" +
         view(0, 48, 0, corners.size(), R"(,"byteStride":12,"count":4,"mode":"ATTRIBUTES")") + "," +
         view(48, 48, corners.size(), faces.size(), R"(,"byteStride":4,"count":12,"mode":"TRIANGLES")") +
         R"(],"buffers":[)" + buffer_of(corners + faces) +
         R"(,{"byteLength":96,"extensions":{"EXT_meshopt_compression":{"fallback":true}}}]})";
}

}  // namespace

std::string base64(const std::string& bytes) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string s;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto at = [&](std::size_t k) {
      return k < bytes.size() ? static_cast<unsigned>(static_cast<unsigned char>(bytes[k])) : 0u;
    };
    const unsigned word = at(i) << 16 | at(i + 1) << 8 | at(i + 2);
    for (std::size_t k = 0; k < 4; ++k) s += i + k > bytes.size() ? '=' : digits[word >> (18 - 6 * k) & 63];
  }
  return s;
}

std::vector<Seed> compressed_gltf() {
  return {{"draco", draco_gltf(), Grammar::json}, {"meshopt", meshopt_gltf(), Grammar::json}};
}

}  // namespace tegotae
