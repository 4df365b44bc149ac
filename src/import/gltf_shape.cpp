#include "import/gltf_shape.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>

namespace tegotae {
namespace {

using nlohmann::json;

constexpr const char* kDraco = "KHR_draco_mesh_compression";
constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
// Attributes are numbered in a Draco stream; a higher number is damage.
constexpr std::size_t kMostDracoAttributes = 65536;

json* member(json& of, const char* key) {
  if (!of.is_object()) return nullptr;
  const auto found = of.find(key);
  return found == of.end() ? nullptr : &*found;
}

/// The elements of a list; none where there is no list.
json::array_t& list_of(json& of, const char* key) {
  static thread_local json::array_t none;
  none.clear();
  json* list = member(of, key);
  return list != nullptr && list->is_array() ? list->get_ref<json::array_t&>() : none;
}

/// Leaves those members of an object for whose name `keep` holds.
template <class Keep>
void leave(json* of, Keep keep) {
  if (of == nullptr || !of->is_object()) return;
  for (auto it = of->begin(); it != of->end();) it = keep(it.key()) ? std::next(it) : of->erase(it);
}

void leave_one(json* of, const char* key) {
  leave(of, [&](const std::string& name) { return name == key; });
}

bool begins_with(const std::string& text, const char* start) {
  return text.rfind(start, 0) == 0;
}

bool is_placing(const std::string& name) {
  return name == "TRANSLATION" || name == "ROTATION" || name == "SCALE";
}

bool is_color(const json* value) {
  return value != nullptr && value->is_array() && (value->size() == 3 || value->size() == 4) &&
         std::all_of(value->begin(), value->end(), [](const json& x) { return x.is_number(); });
}

class ShapeKeeper {
 public:
  explicit ShapeKeeper(json& top) : top_(top) {}

  void keep(std::vector<std::string>& notes) {
    for (const char* key : {"images", "textures", "samplers", "cameras", "extensions"}) top_.erase(key);
    for (json& animation : list_of(top_, "animations")) animation = json::object();
    for (json& material : list_of(top_, "materials")) keep_color(material);
    for (json& node : list_of(top_, "nodes")) keep_place(node);
    keep_scene();
    stand_in("meshes", R"({"primitives": []})");
    stand_in("skins", R"({"joints": []})");
    for (json& skin : list_of(top_, "skins")) name("accessors", member(skin, "inverseBindMatrices"));
    for (json& mesh : list_of(top_, "meshes"))
      for (json& primitive : list_of(mesh, "primitives")) keep_primitive(primitive);
    for (json& accessor : named("accessors")) name_data(accessor);
    stand_in("accessors", R"({"componentType": 5126, "count": 0, "type": "SCALAR"})");
    for (json& view : named("bufferViews")) {
      name("buffers", member(view, "buffer"));
      if (json* all = member(view, "extensions"))
        if (json* meshopt = member(*all, "EXT_meshopt_compression")) name("buffers", member(*meshopt, "buffer"));
    }
    if (named_["bufferViews"].empty()) top_.erase("bufferViews");
    stand_in("bufferViews", R"({"buffer": 0, "byteLength": 0})");
    stand_in("buffers", R"({"byteLength": 0})");
    if (lost_color_)
      notes.push_back(
          "colors of materials that the file does not have are not read; color in the scene file gives a part its "
          "color");
  }

 private:
  /// Something that counts names the element `index` of a list.
  void name(const char* list, const json* index) {
    if (index != nullptr && index->is_number_unsigned()) named_[list].push_back(index->get<std::size_t>());
  }

  /// The elements of a list that are named, each once.
  std::vector<std::reference_wrapper<json>> named(const char* list) {
    std::vector<std::size_t>& all = named_[list];
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    std::vector<std::reference_wrapper<json>> out;
    json::array_t& elements = list_of(top_, list);
    for (const std::size_t i : all)
      if (i < elements.size()) out.emplace_back(elements[i]);
    return out;
  }

  /// Puts `instead` in the place of those that nothing names.
  void stand_in(const char* list, const char* text) {
    const json instead = json::parse(text);
    named(list);  // sorts them
    const std::vector<std::size_t>& all = named_[list];
    json::array_t& elements = list_of(top_, list);
    for (std::size_t i = 0; i < elements.size(); ++i)
      if (!std::binary_search(all.begin(), all.end(), i)) elements[i] = instead;
  }

  /// Of the scenes the one that is read.
  void keep_scene() {
    const json* told = member(top_, "scene");
    if (told != nullptr && !told->is_number_unsigned()) return;
    const std::size_t read = told == nullptr ? 0 : told->get<std::size_t>();
    json::array_t& scenes = list_of(top_, "scenes");
    for (std::size_t i = 0; i < scenes.size(); ++i)
      if (i != read) scenes[i] = json::object();
  }

  static void keep_color(json& material) {
    json plain = json::object();
    if (json* base = member(material, "pbrMetallicRoughness")) {
      plain["pbrMetallicRoughness"] = json::object();
      const json* color = member(*base, "baseColorFactor");
      if (is_color(color)) plain["pbrMetallicRoughness"]["baseColorFactor"] = *color;
    }
    constexpr const char* kGlossy = "KHR_materials_pbrSpecularGlossiness";
    if (json* all = member(material, "extensions")) {
      if (json* glossy = member(*all, kGlossy)) {
        plain["extensions"][kGlossy] = json::object();
        const json* color = member(*glossy, "diffuseFactor");
        if (is_color(color)) plain["extensions"][kGlossy]["diffuseFactor"] = *color;
      }
    }
    material = std::move(plain);
  }

  void keep_place(json& node) {
    if (!node.is_object()) return;
    node.erase("camera");
    leave_one(member(node, "extensions"), kInstancing);
    name("meshes", member(node, "mesh"));
    name("skins", member(node, "skin"));
    json* all = member(node, "extensions");
    json* instances = all == nullptr ? nullptr : member(*all, kInstancing);
    json* attributes = instances == nullptr ? nullptr : member(*instances, "attributes");
    leave(attributes, is_placing);
    name_all(attributes);
  }

  void name_all(json* attributes) {
    if (attributes != nullptr && attributes->is_object())
      for (json& accessor : *attributes) name("accessors", &accessor);
  }

  void keep_primitive(json& primitive) {
    if (!primitive.is_object()) return;
    leave(member(primitive, "attributes"), [](const std::string& attribute) {
      return attribute == "POSITION" || begins_with(attribute, "JOINTS_") || begins_with(attribute, "WEIGHTS_");
    });
    name_all(member(primitive, "attributes"));
    name("accessors", member(primitive, "indices"));
    for (json& target : list_of(primitive, "targets")) {
      leave_one(&target, "POSITION");
      name_all(&target);
    }
    leave_one(member(primitive, "extensions"), kDraco);
    if (json* all = member(primitive, "extensions"))
      if (json* draco = member(*all, kDraco)) keep_draco(*draco);
    const json* material = member(primitive, "material");
    if (material == nullptr) return;
    if (material->is_number_unsigned() && material->get<std::size_t>() < list_of(top_, "materials").size()) return;
    primitive.erase("material");
    lost_color_ = true;
  }

  /// cgltf takes the number of an attribute in the stream for an accessor's, of which there may be fewer.
  void keep_draco(json& draco) {
    name("bufferViews", member(draco, "bufferView"));
    json* attributes = member(draco, "attributes");
    leave_one(attributes, "POSITION");
    const json* number = attributes == nullptr ? nullptr : member(*attributes, "POSITION");
    if (number == nullptr || !number->is_number_unsigned()) return;
    const std::size_t i = number->get<std::size_t>();
    json::array_t& accessors = list_of(top_, "accessors");
    if (i < kMostDracoAttributes && i >= accessors.size() && !accessors.empty()) accessors.resize(i + 1);
  }

  void name_data(json& accessor) {
    name("bufferViews", member(accessor, "bufferView"));
    json* sparse = member(accessor, "sparse");
    if (sparse == nullptr) return;
    for (const char* part : {"indices", "values"})
      if (json* of = member(*sparse, part)) name("bufferViews", member(*of, "bufferView"));
  }

  json& top_;
  std::map<std::string, std::vector<std::size_t>> named_;
  bool lost_color_ = false;
};

}  // namespace

void keep_shape(json& top, std::vector<std::string>& notes) {
  ShapeKeeper(top).keep(notes);
}

}  // namespace tegotae
