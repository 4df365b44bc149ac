#include "import/gltf_check.hpp"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "core/whole_number.hpp"
#include "import/check_text.hpp"
#include "import/file_check.hpp"
#include "import/gltf_buffers.hpp"
#include "import/gltf_shape.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

using nlohmann::json;

// Far deeper than any assembly, and far from the end of the stack for those who walk the tree.
constexpr std::size_t kDeepest = 1000;
// Some JSON readers go down into lists and objects by recursion.
constexpr int kDeepestJson = 100;
// Streams of EXT_meshopt_compression that say that they hold more than this many times their size are damaged.
constexpr std::uint64_t kMaxCompression = 2000;
// Elements of an accessor without data: each costs up to 64 bytes.
constexpr std::uint64_t kMaxZeros = 10'000'000;
constexpr const char* kMeshopt = "EXT_meshopt_compression";

/// Whether the extension is read, or changes nothing of shape and place.
bool is_known_extension(const std::string& name) {
  static const std::set<std::string> known = {
      kMeshopt, "EXT_mesh_gpu_instancing", "KHR_draco_mesh_compression", "KHR_mesh_quantization",
      // Lights, and what is told about the file.
      "KHR_lights_punctual", "EXT_lights_ies", "EXT_lights_image_based", "KHR_xmp", "KHR_xmp_json_ld",
      "EXT_mesh_features", "EXT_structural_metadata", "EXT_instance_features", "MSFT_texture_dds"};
  const auto begins = [&](const char* start) { return name.rfind(start, 0) == 0; };
  return known.count(name) > 0 || begins("KHR_materials_") || begins("EXT_materials_") || begins("ADOBE_materials_") ||
         begins("KHR_texture_") || begins("EXT_texture_");
}

class GltfCheck {
 public:
  GltfCheck(const std::string& path, const json& top, std::uint64_t chunk) : path_(path), top_(top), chunk_(chunk) {}

  /// Extensions that are not read, a note each; throws for those without which the file must not be read.
  std::vector<std::string> check_extensions() const {
    for (const json& name : list("extensionsRequired"))
      if (!is_known_extension(name.get<std::string>()))
        refuse("it requires the glTF extension " + name.get<std::string>() + ", which is not read");
    std::vector<std::string> notes;
    for (const json& name : list("extensionsUsed"))
      if (!is_known_extension(name.get<std::string>()))
        notes.push_back("the glTF extension " + name.get<std::string>() +
                        " is not read; export without it if a shape or a place is wrong");
    return notes;
  }

  void run() const {
    each("buffers", [this](std::size_t i) { check_buffer(i); });
    each("bufferViews", [this](std::size_t i) { check_view(i); });
    each("accessors", [this](std::size_t i) { check_accessor(i); });
    each("meshes", [this](std::size_t i) { check_mesh(i); });
    each("skins", [this](std::size_t i) { check_skin(i); });
    check_nodes();
    if (top_.contains("scene")) reference(top_["scene"], "scenes", "the file");
  }

 private:
  /// An error of the JSON tells of which element it is.
  template <class Check>
  void each(const char* elements, Check check) const {
    for (std::size_t i = 0; i < list(elements).size(); ++i) {
      try {
        check(i);
      } catch (const json::exception& e) {
        refuse("damaged: " + std::string(elements) + " " + std::to_string(i) + ": " + e.what());
      }
    }
  }

  [[noreturn]] void refuse(const std::string& why) const { throw Error(path_ + ": " + why); }

  const json& list(const char* key) const {
    static const json empty = json::array();
    const auto found = top_.find(key);
    if (found == top_.end()) return empty;
    if (!found->is_array()) refuse(std::string("damaged: ") + key + " is not a list");
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
    if (!buffer.contains("uri") && is_fallback(buffer)) return;
    // What the others have instead is for extensions to say; whoever uses them finds that they have nothing.
    if (!buffer.contains("uri") && i > 0) return;
    std::uint64_t there = chunk_;
    if (buffer.contains("uri")) {
      const auto uri = buffer["uri"].get<std::string>();
      if (uri.rfind("data:", 0) == 0) {
        if (uri.substr(0, uri.find(',')).find(";base64") == std::string::npos)
          refuse("buffer " + std::to_string(i) + " is data in an URI, but not base64, which alone is read");
        there = (uri.size() - std::min(uri.size(), uri.find(',') + 1)) / 4 * 3;
        there += 3;  // without padding
      } else {
        const std::filesystem::path file = std::filesystem::path(path_).parent_path() / decoded_uri(uri);
        std::error_code status;
        if (!std::filesystem::is_regular_file(file, status)) refuse("its buffer " + file.string() + " is missing");
        there = std::filesystem::file_size(file);
      }
    }
    if (there < bytes)
      refuse("truncated: buffer " + std::to_string(i) + " has " + std::to_string(there) + " of " +
             std::to_string(bytes) + " bytes");
  }

  /// Whether a buffer stands for what others hold compressed, and has no data of its own.
  static bool is_fallback(const json& buffer) {
    const json* meshopt = extension(buffer, kMeshopt);
    return meshopt != nullptr && meshopt->value("fallback", false);
  }

  static const json* extension(const json& of, const char* name) {
    const auto all = of.find("extensions");
    if (all == of.end() || !all->is_object() || !all->contains(name)) return nullptr;
    return &(*all)[name];
  }

  void check_view(std::size_t i) const {
    const json& view = list("bufferViews")[i];
    const std::string self = called("bufferView", i);
    const json& buffer = list("buffers")[reference(view.at("buffer"), "buffers", self)];
    const std::uint64_t whole = whole_number<std::uint64_t>(buffer.at("byteLength")),
                        from = number(view, "byteOffset", 0);
    if (from > whole || whole_number<std::uint64_t>(view.at("byteLength")) > whole - from)
      refuse("damaged: " + self + " reaches past the end of its buffer");
    if (const json* meshopt = extension(view, kMeshopt))
      check_meshopt(*meshopt, whole_number<std::uint64_t>(view.at("byteLength")), self);
  }

  /// What the decoder takes for granted; `bytes` are those of the view that it fills.
  void check_meshopt(const json& from, std::uint64_t bytes, const std::string& self) const {
    const json& buffer = list("buffers")[reference(from.at("buffer"), "buffers", self)];
    const auto whole = whole_number<std::uint64_t>(buffer.at("byteLength")), offset = number(from, "byteOffset", 0),
               size = whole_number<std::uint64_t>(from.at("byteLength")),
               stride = whole_number<std::uint64_t>(from.at("byteStride")),
               count = whole_number<std::uint64_t>(from.at("count"));
    const std::string mode = from.at("mode").get<std::string>(), filter = from.value("filter", "NONE");
    const bool attributes = mode == "ATTRIBUTES";
    const bool shape =
        attributes ? stride > 0 && stride % 4 == 0 && stride <= 256
                   : (mode == "INDICES" || (mode == "TRIANGLES" && count % 3 == 0)) && (stride == 2 || stride == 4);
    const bool filtered =
        filter == "NONE" || (attributes && ((filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) ||
                                            (filter == "QUATERNION" && stride == 8) || filter == "EXPONENTIAL"));
    if (offset > whole || size > whole - offset || !shape || !filtered || count > bytes || count * stride != bytes ||
        bytes > kMaxCompression * size)
      refuse("damaged: " + self + " has no sizes that " + kMeshopt + " allows");
  }

  void check_accessor(std::size_t i) const {
    const json& accessor = list("accessors")[i];
    const std::string self = called("accessor", i);
    const auto count = whole_number<std::uint64_t>(accessor.at("count"));
    const std::uint64_t size = element_bytes(accessor, self);
    if (accessor.contains("sparse")) {
      const json& sparse = accessor["sparse"];
      const auto few = whole_number<std::uint64_t>(sparse.at("count"));
      check_elements(sparse.at("indices"), few, scalar_bytes(sparse.at("indices"), self), self);
      check_elements(sparse.at("values"), few, size, self);
      if (few > count) refuse("damaged: " + self + " changes more elements than it has");
    }
    if (accessor.contains("bufferView")) {
      check_elements(accessor, count, size, self);
    } else if (count > kMaxZeros) {
      // Of zeros, or told by an extension; too many to be believed.
      refuse("damaged: " + self + " has no bufferView and " + std::to_string(count) + " elements");
    }
  }

  /// Whether the bufferView that `of` names has room for `count` elements of `size` bytes.
  void check_elements(const json& of, std::uint64_t count, std::uint64_t size, const std::string& self) const {
    const json& view = list("bufferViews")[reference(of.at("bufferView"), "bufferViews", self)];
    const std::uint64_t whole = whole_number<std::uint64_t>(view.at("byteLength")), from = number(of, "byteOffset", 0);
    const std::uint64_t stated = number(view, "byteStride", 0);  // as if it were not there, where it is 0
    if (stated > 0 && stated < size)
      refuse("damaged: the elements of " + self + " overlap: its byteStride is too small");
    const std::uint64_t stride = std::max(size, stated);
    if (count == 0) return;
    if (from > whole || size > whole - from || (count - 1) > (whole - from - size) / stride)
      refuse("damaged: " + self + " reaches past the end of its bufferView");
  }

  std::uint64_t scalar_bytes(const json& of, const std::string& self) const {
    switch (whole_number<int>(of.at("componentType"))) {
      case 5120:
      case 5121:
        return 1;
      case 5122:
      case 5123:
        return 2;
      case 5125:
      case 5126:
        return 4;
      default:
        refuse("damaged: " + self + " has an unknown componentType");
    }
  }

  std::uint64_t element_bytes(const json& accessor, const std::string& self) const {
    std::uint64_t n = 0;
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
    return scalar_bytes(accessor, self) * n;
  }

  void check_mesh(std::size_t i) const {
    for (const json& primitive : list("meshes")[i].at("primitives")) {
      check_accessors(primitive.at("attributes"), called("mesh", i));
      if (primitive.contains("targets"))
        for (const json& target : primitive["targets"]) check_accessors(target, called("mesh", i));
      if (const json* draco = extension(primitive, "KHR_draco_mesh_compression"))
        reference(draco->at("bufferView"), "bufferViews", called("mesh", i));
      if (primitive.contains("indices")) reference(primitive["indices"], "accessors", called("mesh", i));
      if (primitive.contains("material")) reference(primitive["material"], "materials", called("mesh", i));
    }
  }

  void check_accessors(const json& attributes, const std::string& self) const {
    for (const json& accessor : attributes) reference(accessor, "accessors", self);
  }

  void check_skin(std::size_t i) const {
    const json& skin = list("skins")[i];
    for (const json& joint : skin.at("joints")) reference(joint, "nodes", called("skin", i));
    if (skin.contains("skeleton")) reference(skin["skeleton"], "nodes", called("skin", i));
    if (skin.contains("inverseBindMatrices")) reference(skin["inverseBindMatrices"], "accessors", called("skin", i));
  }

  /// Every node has one parent at most and hangs under a root.
  void check_nodes() const {
    const std::size_t n = list("nodes").size();
    std::vector<std::vector<std::uint64_t>> children(n);
    std::vector<bool> child(n, false);
    each("nodes", [&](std::size_t i) {
      const json& node = list("nodes")[i];
      if (node.contains("mesh")) reference(node["mesh"], "meshes", called("node", i));
      if (node.contains("skin")) reference(node["skin"], "skins", called("node", i));
      if (node.contains("matrix")) check_matrix(node["matrix"], called("node", i));
      if (const json* instances = extension(node, "EXT_mesh_gpu_instancing"))
        check_accessors(instances->at("attributes"), called("node", i));
      if (!node.contains("children")) return;
      for (const json& c : node["children"]) {
        const std::uint64_t to = reference(c, "nodes", called("node", i));
        if (child[to]) refuse("damaged: node " + std::to_string(to) + " has two parents; nodes must be a tree");
        child[to] = true;
        children[i].push_back(to);
      }
    });
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
    each("scenes", [&](std::size_t i) {
      const json& scene = list("scenes")[i];
      if (!scene.contains("nodes")) return;
      std::set<std::uint64_t> roots;
      for (const json& root : scene["nodes"]) {
        const std::uint64_t node = reference(root, "nodes", called("scene", i));
        if (child[node]) refuse("damaged: a root node of a scene is another's child");
        if (!roots.insert(node).second)
          refuse("damaged: " + called("scene", i) + " names node " + std::to_string(node) + " twice");
      }
    });
  }

  /// By columns. Other last rows than 0 0 0 1 bend space, which no place of a rigid part does.
  void check_matrix(const json& matrix, const std::string& self) const {
    for (const std::size_t k : {3, 7, 11, 15})
      if (!(std::abs(matrix.at(k).get<double>() - (k == 15 ? 1 : 0)) <= kRoundedRow))
        refuse("damaged: the matrix of " + self + " is not a pose: its last row is not 0 0 0 1");
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

/// The JSON of a GLB file; `chunk` becomes its binary chunk.
std::string_view glb_json(const std::string& path, std::string_view bytes, std::string_view& chunk) {
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  if (bytes.size() < kHeader || bytes.substr(0, 4) != "glTF") throw Error(path + ": damaged: no glTF binary header");
  if (word(bytes, 4) != 2)
    throw Error(path + ": glTF version " + std::to_string(word(bytes, 4)) + " is not read (2.0 is)");
  if (word(bytes, 8) > bytes.size()) throw Error(path + ": truncated: shorter than its header says");
  if (bytes.size() < kHeader + kChunkHeader || bytes.substr(16, 4) != "JSON")
    throw Error(path + ": damaged: it has no JSON chunk");
  const std::uint64_t length = word(bytes, kHeader);
  const std::uint64_t end = kHeader + kChunkHeader + length;
  if (end > bytes.size()) throw Error(path + ": truncated: its JSON chunk reaches past the end");
  // The chunk behind it is the buffer's; the format wants others passed over.
  if (end + kChunkHeader <= bytes.size() && bytes.substr(end + 4, 4) == std::string_view("BIN\0", 4)) {
    const std::uint64_t size = word(bytes, end);
    if (size > bytes.size() - end - kChunkHeader)
      throw Error(path + ": truncated: its binary chunk reaches past the end");
    chunk = bytes.substr(end + kChunkHeader, size);
  }
  return bytes.substr(kHeader + kChunkHeader, length);
}

/// Numbers like 8.0 become whole numbers, which JSON does not tell apart and some programs write.
void make_whole(json& value) {
  constexpr double kExact = 9007199254740992;  // 2^53
  if (value.is_structured())
    for (json& inside : value) make_whole(inside);
  if (!value.is_number_float()) return;
  const auto x = value.get<double>();
  if (x != std::floor(x) || std::abs(x) > kExact || (x == 0 && std::signbit(x))) return;
  value = x < 0 ? json(static_cast<std::int64_t>(x)) : json(static_cast<std::uint64_t>(x));
}

}  // namespace

CheckedGltf check_gltf(const std::string& path, std::string_view bytes) {
  CheckedGltf out;
  require_unpacked(path, bytes);
  const bool binary = lower_extension(path) == ".glb" ? bytes.substr(0, 1) != "{" : bytes.substr(0, 4) == "glTF";
  const std::string_view text = binary ? glb_json(path, bytes, out.chunk) : bytes;
  require_single_bytes(path, text);
  const auto shallow = [&path](int depth, json::parse_event_t, json&) {
    if (depth > kDeepestJson)
      throw Error(path + ": its JSON is nested more than " + std::to_string(kDeepestJson) + " deep");
    return true;
  };
  json top = json::parse(text.begin(), text.end(), shallow, false);
  if (top.is_discarded() || !top.is_object()) throw Error(path + ": truncated or damaged: not valid JSON");
  make_whole(top);
  try {
    const auto version = top.at("asset").at("version").get<std::string>();
    if (version.rfind("2.", 0) != 0) throw Error(path + ": glTF version " + version + " is not read (2.0 is)");
    const std::string least = top["asset"].value("minVersion", "2.0");
    if (least != "2.0" && least.rfind("1.", 0) != 0 && least.rfind("0.", 0) != 0)
      throw Error(path + ": it requires a reader of glTF " + least + "; 2.0 is read");
    const GltfCheck check(path, top, out.chunk.size());
    out.notes = check.check_extensions();
    keep_shape(top, out.notes);
    check.run();
    out.json = top.dump();
  } catch (const json::exception& e) {
    throw Error(path + ": damaged: " + e.what());
  }
  return out;
}

}  // namespace tegotae
