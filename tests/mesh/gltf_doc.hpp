#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/run_program.hpp"

namespace tegotae::test {

using Json = nlohmann::json;

/// Writes small glTF files by hand: a unit tetrahedron (corners 0, x, y, z) stored in many ways.
class GltfDoc {
 public:
  Json j = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", Json::array()}}}}};

  template <class T>
  static std::string bytes_of(const std::vector<T>& values) {
    std::string bytes(sizeof(T) * values.size(), '\0');
    if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
  }

  std::size_t view(const std::string& bytes) {
    data_.resize((data_.size() + 3) / 4 * 4);
    j["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", data_.size()}, {"byteLength", bytes.size()}});
    data_ += bytes;
    return j["bufferViews"].size() - 1;
  }

  std::size_t accessor(const std::string& bytes, int type, const char* shape, std::size_t count) {
    j["accessors"].push_back({{"bufferView", view(bytes)}, {"componentType", type}, {"count", count}, {"type", shape}});
    return j["accessors"].size() - 1;
  }
  std::size_t floats(const std::vector<float>& values, const char* shape, std::size_t components) {
    return accessor(bytes_of(values), 5126, shape, values.size() / components);
  }
  std::size_t corners() { return floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3", 3); }
  std::size_t faces() {
    return accessor(bytes_of(std::vector<std::uint16_t>{0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3}), 5123, "SCALAR", 12);
  }

  std::size_t mesh(const Json& primitive) {
    j["meshes"].push_back({{"name", "tip"}, {"primitives", {primitive}}});
    return j["meshes"].size() - 1;
  }
  Json tetrahedron() { return {{"attributes", {{"POSITION", corners()}}}, {"indices", faces()}}; }

  std::size_t node(const Json& node, bool root = true) {
    j["nodes"].push_back(node);
    if (root) j["scenes"][0]["nodes"].push_back(j["nodes"].size() - 1);
    return j["nodes"].size() - 1;
  }

  void uses(const char* extension, bool required = true) {
    j["extensionsUsed"].push_back(extension);
    if (required) j["extensionsRequired"].push_back(extension);
  }

  /// Writes NAME.gltf and its buffer; returns its path.
  std::string save(const TempFolder& folder, const std::string& name = "a") const {
    Json all = j;
    Json buffer = {{"byteLength", data_.size()}, {"uri", name + ".bin"}};
    if (all.contains("buffers"))
      all["buffers"].insert(all["buffers"].begin(), buffer);
    else
      all["buffers"] = nlohmann::json::array({buffer});  // clang takes {buffer} for a copy of it
    folder.write(name + ".bin", data_);
    folder.write(name + ".gltf", all.dump());
    return folder / (name + ".gltf");
  }

 private:
  std::string data_;
};

}  // namespace tegotae::test
