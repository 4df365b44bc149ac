#include "mesh/gltf_check.hpp"

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/whole_number.hpp"
#include "mesh/file_check.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

using nlohmann::json;

// Far deeper than any assembly, and far from the end of the stack for those who walk the tree.
constexpr std::size_t kDeepest = 1000;
// assimp's JSON reader goes down into lists and objects by recursion.
constexpr int kDeepestJson = 100;

class GltfCheck {
 public:
  GltfCheck(const std::string& path, const json& top, std::uint64_t chunk) : path_(path), top_(top), chunk_(chunk) {}

  void run() const {
    for (std::size_t i = 0; i < list("buffers").size(); ++i) check_buffer(i);
    for (std::size_t i = 0; i < list("bufferViews").size(); ++i) check_view(i);
    for (std::size_t i = 0; i < list("accessors").size(); ++i) check_accessor(i);
    for (std::size_t i = 0; i < list("meshes").size(); ++i) check_mesh(i);
    check_nodes();
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const { throw Error(path_ + ": " + why); }

  const json& list(const char* key) const {
    static const json empty = json::array();
    const auto found = top_.find(key);
    if (found == top_.end()) return empty;
    if (!found->is_array()) refuse(std::string("damaged: ") + key + " is no list");
    return *found;
  }

  /// The number under `key`; a reference to the list `to`, if there is one.
  std::uint64_t number(const json& of, const char* key, std::uint64_t fallback) const {
    return of.contains(key) ? whole_number<std::uint64_t>(of.at(key)) : fallback;
  }
  std::uint64_t reference(const json& value, const char* to, const std::string& by) const {
    const auto i = whole_number<std::uint64_t>(value);
    if (i >= list(to).size())
      refuse("index out of range: " + by + " names " + to + " " + std::to_string(i) + " of " +
             std::to_string(list(to).size()));
    return i;
  }
  static std::string called(const char* what, std::size_t i) { return std::string(what) + " " + std::to_string(i); }

  void check_buffer(std::size_t i) const {
    const json& buffer = list("buffers")[i];
    const auto bytes = whole_number<std::uint64_t>(buffer.at("byteLength"));
    std::uint64_t there = chunk_;
    if (buffer.contains("uri")) {
      const auto uri = buffer["uri"].get<std::string>();
      if (uri.rfind("data:", 0) == 0) {
        there = (uri.size() - std::min(uri.size(), uri.find(',') + 1)) / 4 * 3;
        there += 3;  // without padding
      } else {
        const std::filesystem::path file = std::filesystem::path(path_).parent_path() / decoded(uri);
        std::error_code status;
        if (!std::filesystem::is_regular_file(file, status)) refuse("its buffer " + file.string() + " is missing");
        there = std::filesystem::file_size(file);
      }
    }
    if (there < bytes)
      refuse("truncated: buffer " + std::to_string(i) + " has " + std::to_string(there) + " of " +
             std::to_string(bytes) + " bytes");
  }

  static std::string decoded(const std::string& uri) {
    std::string out;
    for (std::size_t i = 0; i < uri.size(); ++i) {
      if (uri[i] == '%' && i + 2 < uri.size() && std::isxdigit(static_cast<unsigned char>(uri[i + 1])) != 0 &&
          std::isxdigit(static_cast<unsigned char>(uri[i + 2])) != 0) {
        out.push_back(static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16)));
        i += 2;
      } else {
        out.push_back(uri[i]);
      }
    }
    return out;
  }

  void check_view(std::size_t i) const {
    const json& view = list("bufferViews")[i];
    const std::string self = called("bufferView", i);
    const json& buffer = list("buffers")[reference(view.at("buffer"), "buffers", self)];
    const std::uint64_t whole = whole_number<std::uint64_t>(buffer.at("byteLength")),
                        from = number(view, "byteOffset", 0);
    if (from > whole || whole_number<std::uint64_t>(view.at("byteLength")) > whole - from)
      refuse("damaged: " + self + " reaches past the end of its buffer");
  }

  void check_accessor(std::size_t i) const {
    const json& accessor = list("accessors")[i];
    const std::string self = called("accessor", i);
    if (accessor.contains("sparse")) refuse(self + " is sparse, which is not read; export it dense");
    const auto count = whole_number<std::uint64_t>(accessor.at("count"));
    const std::uint64_t size = element_bytes(accessor, self);
    if (!accessor.contains("bufferView")) return;
    const json& view = list("bufferViews")[reference(accessor["bufferView"], "bufferViews", self)];
    const std::uint64_t whole = whole_number<std::uint64_t>(view.at("byteLength")),
                        from = number(accessor, "byteOffset", 0);
    const std::uint64_t stride = std::max(size, number(view, "byteStride", size));
    if (count == 0) return;
    if (from > whole || size > whole - from || (count - 1) > (whole - from - size) / stride)
      refuse("damaged: " + self + " reaches past the end of its bufferView");
  }

  std::uint64_t element_bytes(const json& accessor, const std::string& self) const {
    std::uint64_t scalar = 0, n = 0;
    switch (whole_number<int>(accessor.at("componentType"))) {
      case 5120:
      case 5121:
        scalar = 1;
        break;
      case 5122:
      case 5123:
        scalar = 2;
        break;
      case 5125:
      case 5126:
        scalar = 4;
        break;
      default:
        refuse("damaged: " + self + " has an unknown componentType");
    }
    const auto type = accessor.at("type").get<std::string>();
    for (const auto& [name, numbers] : {std::pair<const char*, int>{"SCALAR", 1},
                                        {"VEC2", 2},
                                        {"VEC3", 3},
                                        {"VEC4", 4},
                                        {"MAT2", 4},
                                        {"MAT3", 9},
                                        {"MAT4", 16}})
      if (type == name) n = static_cast<std::uint64_t>(numbers);
    if (n == 0) refuse("damaged: " + self + " has an unknown type " + type);
    return scalar * n;
  }

  void check_mesh(std::size_t i) const {
    for (const json& primitive : list("meshes")[i].at("primitives")) {
      if (primitive.contains("extensions") && primitive["extensions"].contains("KHR_draco_mesh_compression"))
        refuse("its meshes are Draco-compressed, which is not read; export it without compression");
      for (const json& accessor : primitive.at("attributes")) reference(accessor, "accessors", called("mesh", i));
      if (primitive.contains("indices")) reference(primitive["indices"], "accessors", called("mesh", i));
      if (primitive.contains("material")) reference(primitive["material"], "materials", called("mesh", i));
    }
  }

  /// Every node has one parent at most and hangs under a root.
  void check_nodes() const {
    const std::size_t n = list("nodes").size();
    std::vector<std::vector<std::uint64_t>> children(n);
    std::vector<bool> child(n, false);
    for (std::size_t i = 0; i < n; ++i) {
      const json& node = list("nodes")[i];
      if (node.contains("mesh")) reference(node["mesh"], "meshes", called("node", i));
      if (!node.contains("children")) continue;
      for (const json& c : node["children"]) {
        const std::uint64_t to = reference(c, "nodes", called("node", i));
        if (child[to]) refuse("damaged: node " + std::to_string(to) + " has two parents; nodes must be a tree");
        child[to] = true;
        children[i].push_back(to);
      }
    }
    std::vector<std::uint64_t> level;
    std::size_t reached = 0, depth = 0;
    for (std::size_t i = 0; i < n; ++i)
      if (!child[i]) level.push_back(i);
    for (; !level.empty(); ++depth) {
      if (depth > kDeepest) refuse("its nodes are nested more than " + std::to_string(kDeepest) + " deep");
      reached += level.size();
      std::vector<std::uint64_t> next;
      for (const std::uint64_t i : level) next.insert(next.end(), children[i].begin(), children[i].end());
      level = std::move(next);
    }
    if (reached < n) refuse("damaged: its nodes go in a circle");
    for (const json& scene : list("scenes")) {
      if (!scene.contains("nodes")) continue;
      for (const json& root : scene["nodes"])
        if (child[reference(root, "nodes", "a scene")]) refuse("damaged: a root node of a scene is another's child");
    }
  }

  const std::string& path_;
  const json& top_;
  const std::uint64_t chunk_;  ///< bytes of the binary chunk of a GLB file
};

std::uint32_t word(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  return value;
}

/// The JSON of a GLB file; `chunk` is the size of its binary chunk.
std::string_view glb_json(const std::string& path, std::string_view bytes, std::uint64_t& chunk) {
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  if (bytes.size() < kHeader || bytes.substr(0, 4) != "glTF") throw Error(path + ": damaged: no glTF binary header");
  if (word(bytes, 8) > bytes.size()) throw Error(path + ": truncated: shorter than its header says");
  if (bytes.size() < kHeader + kChunkHeader || bytes.substr(16, 4) != "JSON")
    throw Error(path + ": damaged: it has no JSON chunk");
  const std::uint64_t length = word(bytes, kHeader);
  const std::uint64_t end = kHeader + kChunkHeader + length;
  if (end > bytes.size()) throw Error(path + ": truncated: its JSON chunk reaches past the end");
  if (end + kChunkHeader <= bytes.size()) {
    chunk = word(bytes, end);
    if (chunk > bytes.size() - end - kChunkHeader)
      throw Error(path + ": truncated: its binary chunk reaches past the end");
  }
  return bytes.substr(kHeader + kChunkHeader, length);
}

}  // namespace

void check_gltf(const std::string& path, std::string_view bytes) {
  std::uint64_t chunk = 0;
  const bool binary = lower_extension(path) == ".glb";
  const std::string_view text = binary ? glb_json(path, bytes, chunk) : bytes;
  const auto shallow = [&path](int depth, json::parse_event_t, json&) {
    if (depth > kDeepestJson)
      throw Error(path + ": its JSON is nested more than " + std::to_string(kDeepestJson) + " deep");
    return true;
  };
  const json top = json::parse(text.begin(), text.end(), shallow, false);
  if (top.is_discarded() || !top.is_object()) throw Error(path + ": truncated or damaged: not valid JSON");
  try {
    const auto version = top.at("asset").at("version").get<std::string>();
    if (version.rfind("2.", 0) != 0) throw Error(path + ": glTF version " + version + " is not read (2.0 is)");
    GltfCheck(path, top, chunk).run();
  } catch (const json::exception& e) {
    throw Error(path + ": damaged: " + e.what());
  }
}

}  // namespace tegotae
