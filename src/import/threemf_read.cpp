#include "import/threemf_read.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <pugixml.hpp>
#include <sstream>

#include "import/file_check.hpp"
#include "import/note_texts.hpp"
#include "import/utf8.hpp"
#include "import/zip_archive.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

// Components may name components; more levels, or parts and groups, than these are made to do harm.
constexpr int kDeepest = 100;
constexpr std::size_t kMaxParts = 1'000'000;
// What a required extension may be: production splits a file into several, materials tell colors, triangle sets
// give names.
constexpr std::array<const char*, 5> kKnownExtensions = {
    "http://schemas.microsoft.com/3dmanufacturing/core/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06",
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07",
    "http://schemas.3mf.io/3dmanufacturing/displaycolor"};

/// The name of an element or attribute without its namespace's prefix.
bool is(const char* name, const char* plain) {
  const char* colon = std::strchr(name, ':');
  return std::strcmp(colon == nullptr ? name : colon + 1, plain) == 0;
}

pugi::xml_node child(const pugi::xml_node& of, const char* name) {
  return of.find_child([&](const pugi::xml_node& n) { return is(n.name(), name); });
}

std::string attribute(const pugi::xml_node& of, const char* name) {
  return of.find_attribute([&](const pugi::xml_attribute& a) { return is(a.name(), name); }).value();
}

class ThreeMfReader {
 public:
  explicit ThreeMfReader(const std::string& path) : path_(path), archive_(path) {}

  PartFile read() {
    const std::string start = first_model();
    const pugi::xml_node model = open(start);
    set_unit(attribute(model, "unit"));
    const pugi::xml_node build = child(model, "build");
    std::vector<std::string> groups;
    for (const pugi::xml_node& item : build.children())
      if (is(item.name(), "item")) add(item, start, scaled(transform_of(item)), groups, 0);
    notes_.write_to(file_.notes);
    return std::move(file_);
  }

 private:
  [[noreturn]] void damaged(const std::string& why) const { throw Error(path_ + ": damaged: " + printable(why)); }

  /// Where the archive says that its model is.
  std::string first_model() const {
    pugi::xml_document relations;
    const std::string text = archive_.read("_rels/.rels");
    if (!relations.load_buffer(text.data(), text.size())) damaged("_rels/.rels is not XML");
    for (const pugi::xml_node& r : relations.document_element().children()) {
      const std::string type = attribute(r, "Type");
      if (type.size() >= 8 && type.compare(type.size() - 8, 8, "/3dmodel") == 0) return inside(attribute(r, "Target"));
    }
    damaged("it names no model");
  }

  static std::string inside(const std::string& name) {
    return name.substr(std::min(name.find_first_not_of('/'), name.size()));
  }

  /// The element `model` of a file of the archive.
  pugi::xml_node open(const std::string& name) {
    const auto [known, fresh] = models_.try_emplace(name);
    if (!fresh) return known->second->document_element();
    known->second = std::make_unique<pugi::xml_document>();
    const std::string text = archive_.read(name);
    const pugi::xml_parse_result parsed = known->second->load_buffer(text.data(), text.size());
    const pugi::xml_node model = known->second->document_element();
    if (!parsed || !is(model.name(), "model")) damaged(name + " in it is not a 3MF model");
    check_extensions(model);
    index(name, model);
    return model;
  }

  void index(const std::string& name, const pugi::xml_node& model) {
    for (const pugi::xml_node& object : child(model, "resources").children()) {
      if (!is(object.name(), "object")) continue;
      const std::string id = attribute(object, "id");
      if (!objects_.emplace(std::pair(name, id), object).second)
        damaged(name + " in it has two objects of the id \"" + id + '"');
    }
  }

  void check_extensions(const pugi::xml_node& model) const {
    std::istringstream prefixes(attribute(model, "requiredextensions"));
    for (std::string prefix; prefixes >> prefix;) {
      const std::string space = model.attribute(("xmlns:" + prefix).c_str()).value();
      if (std::find(kKnownExtensions.begin(), kKnownExtensions.end(), space) == kKnownExtensions.end())
        throw Error(path_ + ": it requires the 3MF extension " + (space.empty() ? prefix : space) +
                    ", which is not read");
    }
  }

  void set_unit(const std::string& unit) {
    static const std::map<std::string, std::string> known = {
        {"", "mm"},     {"micron", "um"}, {"millimeter", "mm"}, {"centimeter", "cm"},
        {"inch", "in"}, {"foot", "in"},   {"meter", "m"}};
    const auto found = known.find(unit);
    if (found == known.end()) damaged("its unit \"" + unit + "\" is unknown");
    file_.unit = found->second;
    units_ = unit == "foot" ? 12 : 1;
  }

  /// `place` says of what it is.
  template <class Place>
  double number(std::string_view text, Place place) const {
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n+"), text.size()));
    text = text.substr(0, text.find_last_not_of(" \t\r\n") + 1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
      damaged(place() + " has \"" + printable(std::string(text.substr(0, 40))) + "\" for a number");
    return value;
  }

  /// Rows of the file's matrix multiply row vectors.
  Matrix34 transform_of(const pugi::xml_node& placed) const {
    Matrix34 X = Matrix34::Identity();
    const std::string text = attribute(placed, "transform");
    if (text.empty()) return X;
    const auto place = [&] { return "the transform of the object " + attribute(placed, "objectid"); };
    std::istringstream words(text);
    std::string word;
    for (int k = 0; k < 12; ++k) {
      if (!(words >> word)) damaged(place() + " has fewer than 12 numbers");
      X(k % 3, k / 3) = number(word, place);
    }
    if (words >> word) damaged(place() + " has more than 12 numbers");
    return X;
  }

  Matrix34 scaled(Matrix34 X) const {
    X.col(3) *= units_;
    return X;
  }

  /// The object that `placed`, an item or component in the model file `in`, names; `in` becomes where it is.
  pugi::xml_node object_of(const pugi::xml_node& placed, std::string& in) {
    const std::string path = attribute(placed, "path"), id = attribute(placed, "objectid");
    if (!path.empty()) in = inside(path);
    open(in);
    const auto found = objects_.find({in, id});
    if (found == objects_.end()) damaged("it names the object " + id + ", which is missing in " + in);
    return found->second;
  }

  void add(const pugi::xml_node& placed, std::string in, const Matrix34& X, std::vector<std::string>& groups,
           int depth) {
    if (++placed_ > kMaxParts) damaged("it has more than a million parts and groups");
    const pugi::xml_node object = object_of(placed, in);
    const std::string id = attribute(object, "id"), type = attribute(object, "type");
    std::string name = attribute(object, "name");
    if (name.empty()) name = "object " + id;
    if (type == "support" || type == "solidsupport") {
      notes_.add(note_texts::kSupport, '"' + name + '"');
      return;
    }
    if (type == "other") {
      notes_.add(note_texts::kOther, '"' + name + '"');
      return;
    }
    if (depth > kDeepest) damaged("its components are nested more than " + std::to_string(kDeepest) + " deep");
    if (const pugi::xml_node components = child(object, "components")) {
      groups.push_back(name);
      for (const pugi::xml_node& component : components.children())
        if (is(component.name(), "component"))
          add(component, in, product(X, scaled(transform_of(component))), groups, depth + 1);
      groups.pop_back();
      return;
    }
    if (!child(object, "mesh")) {
      notes_.add(note_texts::kUnreadShape, '"' + name + "\" (" + unread_shape(object) + ')');
      return;
    }
    const auto [known, fresh] = mesh_of_.emplace(std::pair(in, id), file_.meshes.size());
    if (fresh) file_.meshes.push_back(mesh_of(object, name));
    file_.parts.push_back({name, groups, X, known->second, color_of(object, in)});
  }

  /// What stands in an object where the core of the format has its mesh or components.
  static std::string unread_shape(const pugi::xml_node& object) {
    for (const pugi::xml_node& inside : object.children())
      if (inside.type() == pugi::node_element && !is(inside.name(), "metadatagroup")) return inside.name();
    return "empty";
  }

  TriangleMesh mesh_of(const pugi::xml_node& object, const std::string& name) {
    TriangleMesh out;
    out.name = name;
    const pugi::xml_node mesh = child(object, "mesh");
    for (const pugi::xml_node& v : child(mesh, "vertices").children()) {
      if (!is(v.name(), "vertex")) continue;
      const auto place = [&] { return "vertex " + std::to_string(out.vertices.size()) + " of \"" + name + '"'; };
      const auto x = [&](const char* axis) { return number(v.attribute(axis).value(), place); };
      out.vertices.push_back(units_ * Vec3(x("x"), x("y"), x("z")));
    }
    for (const pugi::xml_node& t : child(mesh, "triangles").children()) {
      if (!is(t.name(), "triangle")) continue;
      const auto place = [&] { return "triangle " + std::to_string(out.triangles.size()) + " of \"" + name + '"'; };
      std::array<std::uint32_t, 3> corners{};
      for (std::size_t k = 0; k < 3; ++k) {
        const double index = number(t.attribute(k == 0 ? "v1" : k == 1 ? "v2" : "v3").value(), place);
        if (index != std::floor(index)) damaged(place() + " has an index that is not a whole number");
        if (!(index >= 0 && index < static_cast<double>(out.vertices.size())))
          throw Error(path_ + ": index out of range: " + printable(place()) + " names a vertex that it does not have");
        corners[k] = static_cast<std::uint32_t>(index);
      }
      out.triangles.push_back(corners);
    }
    if (child(mesh, "beamlattice")) notes_.add(note_texts::kLattice, '"' + name + '"');
    if (attribute(object, "meshresolution") == "lowres") notes_.add(note_texts::kSlices, '"' + name + '"');
    return out;
  }

  /// Of the base material that the object as a whole has.
  std::optional<Color> color_of(const pugi::xml_node& object, const std::string& in) {
    const std::string group = attribute(object, "pid");
    if (group.empty()) return std::nullopt;
    const std::string index = attribute(object, "pindex");
    double at = index.empty() ? 0 : number(index, [&] { return "the pindex of object " + attribute(object, "id"); });
    const pugi::xml_node resources = child(open(in), "resources");
    for (const pugi::xml_node& materials : resources.children()) {
      if (!is(materials.name(), "basematerials") || attribute(materials, "id") != group) continue;
      for (const pugi::xml_node& base : materials.children())
        if (is(base.name(), "base") && at-- == 0) return color(attribute(base, "displaycolor"));
    }
    return std::nullopt;
  }

  /// "#RRGGBB" or "#RRGGBBAA", sRGB.
  static std::optional<Color> color(const std::string& text) {
    Color out = {0, 0, 0, 1};
    if ((text.size() != 7 && text.size() != 9) || text[0] != '#') return std::nullopt;
    for (std::size_t k = 0; 2 * k + 1 < text.size(); ++k) {
      int value = 0;
      const char* at = &text[2 * k + 1];
      if (std::from_chars(at, at + 2, value, 16).ptr != at + 2) return std::nullopt;
      out[k] = value / 255.0;
    }
    return out;
  }

  const std::string& path_;
  const ZipArchive archive_;
  std::map<std::string, std::unique_ptr<pugi::xml_document>> models_;      // by their names in the archive
  std::map<std::pair<std::string, std::string>, std::size_t> mesh_of_;     // by model and object
  std::map<std::pair<std::string, std::string>, pugi::xml_node> objects_;  // by model and id
  double units_ = 1;                                                       // of PartFile::unit in one unit of the file
  std::size_t placed_ = 0;                                                 // parts and groups
  ImportNotes notes_;
  PartFile file_;
};

}  // namespace

PartFile read_3mf(const std::string& path) {
  read_mesh_bytes(path);  // refuses what is not a file
  return ThreeMfReader(path).read();
}

}  // namespace tegotae
