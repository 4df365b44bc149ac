// What changes shape or place in glTF: a test for each row of docs/formats.md.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>

#include "mesh/assembly_checks.hpp"
#include "mesh/gltf_doc.hpp"
#include "tegotae/import/load.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

/// glTF's coordinates are floats.
void check_near(const Eigen::AlignedBox3d& box, const Vec3& lo, const Vec3& hi) {
  check_box(box, lo, hi, 2e-6);
}

/// The file read both ways: as parts and as one surface, whose boxes must be the same.
Assembly read(const std::string& file) {
  AssemblyOptions options;
  options.unit = "m";  // also where the parts stand far from each other
  const Assembly a = read_assembly(file, options);
  Eigen::AlignedBox3d parts;
  for (std::size_t i = 0; i < a.parts.size(); ++i) parts.extend(box_of(a, i));
  const MeshReport whole = report(load_mesh(file));
  check_near(parts, whole.box_min, whole.box_max);
  for (const auto& shape : a.shapes) {
    CHECK(report(*shape).closed);
    CHECK(volume(*shape) > 0);
  }
  return a;
}

std::string refused(const std::string& file) {
  return test::refusal([&] { load_mesh(file); }) + test::refusal(file);
}

/// A file of one tetrahedron whose positions are the accessor `position` of `doc`.
Assembly read_with_position(GltfDoc& doc, std::size_t position, const Json& node = {}) {
  const TempFolder folder;
  Json of = node.is_null() ? Json::object() : node;
  of["mesh"] = doc.mesh({{"attributes", {{"POSITION", position}}}, {"indices", doc.faces()}});
  doc.node(of);
  return read(doc.save(folder));
}

}  // namespace

TEST_CASE("GLB: a chunk that is neither JSON nor binary is no buffer", "[gltf]") {
  const TempFolder folder;
  GltfDoc doc;
  doc.node({{"mesh", doc.mesh(doc.tetrahedron())}});
  doc.save(folder);
  Json j = Json::parse(read_text(folder / "a.gltf"));
  j["buffers"][0].erase("uri");
  std::string text = j.dump(), body = read_text(folder / "a.bin");
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto glb = [&](const std::string& kind) {
    const auto size = static_cast<std::uint32_t>(text.size()), bytes = static_cast<std::uint32_t>(body.size());
    return "glTF" + GltfDoc::bytes_of<std::uint32_t>({2, 28 + size + bytes, size}) + "JSON" + text +
           GltfDoc::bytes_of<std::uint32_t>({bytes}) + kind + body;
  };
  folder.write("good.glb", glb(std::string("BIN\0", 4)));
  CHECK(read(folder / "good.glb").parts.size() == 1);
  folder.write("other.glb", glb("NOTE"));
  CHECK_THAT(refused(folder / "other.glb"), Catch::Contains("truncated: buffer 0 has 0 of"));
}

TEST_CASE("glTF: errors name what they are about", "[gltf]") {
  const TempFolder folder;
  GltfDoc doc;
  doc.node(Json::object());
  doc.node({{"mesh", doc.mesh(doc.tetrahedron())}});
  const auto why = [&](const char* list, const char* key, const Json& value) {
    GltfDoc bad = doc;
    bad.j[list][0][key] = value;
    return refused(bad.save(folder));
  };
  CHECK_THAT(why("accessors", "count", "4"), Catch::Contains("accessors 0: "));
  CHECK_THAT(why("bufferViews", "byteLength", -1), Catch::Contains("bufferViews 0: "));
  CHECK_THAT(why("meshes", "primitives", 1), Catch::Contains("meshes 0"));
  CHECK_THAT(why("nodes", "mesh", 0.5), Catch::Contains("nodes 0: "));
  CHECK_THAT(why("accessors", "type", "VEC2"), Catch::Contains("mesh 0, primitive 0 (node 1): "));
  CHECK_THAT(why("nodes", "skin", 3), Catch::Contains("node 0 names skins 3 of 0"));
  doc.j["skins"] = {{{"joints", {7}}}};
  CHECK_THAT(refused(doc.save(folder)), Catch::Contains("skin 0 names nodes 7 of 2"));
  doc.j.erase("skins");
  doc.j["scene"] = 4;
  CHECK_THAT(refused(doc.save(folder)), Catch::Contains("the file names scenes 4 of 1"));
  doc.j["scene"] = 0;
  GltfDoc many = doc;
  many.uses("EXT_mesh_gpu_instancing");
  many.j["accessors"].push_back({{"componentType", 5126}, {"count", 1000001}, {"type", "VEC3"}});
  many.j["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] = many.j["accessors"].size() - 1;
  CHECK_THAT(refused(many.save(folder)), Catch::Contains("instances of node 1: more than a million"));
}

TEST_CASE("glTF: places of nodes: matrix, or scale, rotation, translation; parents; mirrors", "[gltf]") {
  const TempFolder folder;
  GltfDoc doc;
  const std::size_t mesh = doc.mesh(doc.tetrahedron());
  // x doubled, then a quarter turn about z, then 10 in x.
  doc.node({{"mesh", mesh},
            {"scale", {2, 1, 1}},
            {"rotation", {0, 0, 0.70710678, 0.70710678}},
            {"translation", {10, 0, 0}}});
  doc.node({{"mesh", mesh}, {"matrix", {0, 2, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 20, 0, 0, 1}}});
  const std::size_t child = doc.node({{"mesh", mesh}, {"translation", {0, 5, 0}}}, false);
  doc.node({{"name", "mirror"}, {"scale", {-1, 1, 1}}, {"children", {child}}});
  const Assembly a = read(doc.save(folder));
  REQUIRE(a.parts.size() == 3);
  check_near(box_of(a, 0), {9, 0, 0}, {10, 2, 1});
  check_near(box_of(a, 1), {19, 0, 0}, {20, 2, 1});
  check_near(box_of(a, 2), {-1, 5, 0}, {0, 6, 1});
  CHECK(a.parts[0].shape == a.parts[1].shape);
  CHECK(a.parts[2].path == std::vector<std::string>{"mirror"});
}

TEST_CASE("glTF: the scene that the file names is read, the first without one, all roots without scenes", "[gltf]") {
  const TempFolder folder;
  GltfDoc doc;
  const std::size_t mesh = doc.mesh(doc.tetrahedron());
  doc.node({{"mesh", mesh}, {"name", "first"}});
  doc.node({{"mesh", mesh}, {"name", "second"}, {"translation", {3, 0, 0}}}, false);
  doc.j["scenes"].push_back({{"nodes", {1}}});
  doc.j["scene"] = 1;
  CHECK(read(doc.save(folder)).parts.at(0).name == "second");
  doc.j.erase("scene");
  CHECK(read(doc.save(folder)).parts.at(0).name == "first");
  doc.j.erase("scenes");
  CHECK(read(doc.save(folder)).parts.size() == 2);
}

TEST_CASE("glTF: nodes of other scenes, and those scaled to nothing, are told and left out", "[gltf]") {
  const TempFolder folder;
  GltfDoc doc;
  const std::size_t mesh = doc.mesh(doc.tetrahedron());
  doc.node({{"mesh", mesh}});
  CHECK(read(doc.save(folder)).notes.empty());
  doc.node({{"mesh", mesh}, {"name", "hidden"}, {"scale", {0, 0, 0}}});
  doc.node({{"mesh", mesh}, {"translation", {9, 0, 0}}}, false);
  doc.j["scenes"].push_back({{"nodes", {2}}});
  const Assembly a = read(doc.save(folder));
  REQUIRE(a.parts.size() == 1);
  CHECK(has_note(a, "\"hidden\": scaled to nothing"));
  CHECK(has_note(a, "not in the scene that is read: nodes with meshes, 1"));
  doc.node({{"mesh", mesh}, {"translation", {0, 9, 0}}}, false);  // in no scene at all
  CHECK(has_note(read(doc.save(folder)), "not in the scene that is read: nodes with meshes, 2"));
}

TEST_CASE("glTF: nodes that leave a part no volume are told", "[gltf]") {
  const TempFolder folder;
  const auto notes_of = [&](const Json& place, const Json& parent) {
    GltfDoc doc;
    Json node = place;
    node["mesh"] = doc.mesh(doc.tetrahedron());
    node["name"] = "thin";
    const std::size_t child = doc.node(node, false);
    Json above = parent;
    above["children"] = {child};
    doc.node(above);
    const Assembly a = read_assembly(doc.save(folder));
    CHECK(a.parts.size() == 1);
    CHECK(load_mesh(folder / "a.gltf").notes == a.notes);
    return a.notes;
  };
  const Json none = Json::object(), turned = {{"rotation", {0.2, 0.4, 0.4, 0.8}}};
  for (const Json& scale : {Json({1, 1, 0}), Json({0, 3, 1}), Json({-1, 0, 1})}) {
    INFO(scale.dump());
    for (const auto& [place, parent] : {std::pair(Json{{"scale", scale}}, none), {turned, Json{{"scale", scale}}}}) {
      const std::vector<std::string> notes = notes_of(place, parent);
      REQUIRE(notes.size() == 1);
      CHECK_THAT(notes[0], Catch::Contains("\"thin\": scaled to nothing in some direction"));
    }
  }
  CHECK(notes_of({{"scale", {1, 1, 0.001}}}, turned).empty());
  CHECK(notes_of({{"scale", {1e-3, 1e-3, 1e-3}}}, turned).empty());
}

TEST_CASE("glTF: what asks for a newer reader, bends space or names a root twice is refused", "[gltf]") {
  const TempFolder folder;
  GltfDoc doc;
  doc.node({{"mesh", doc.mesh(doc.tetrahedron())}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1}}});
  for (const char* version : {"2.0", "1.0"}) {
    doc.j["asset"]["minVersion"] = version;
    check_near(box_of(read(doc.save(folder)), 0), {5, 0, 0}, {6, 1, 1});
  }
  GltfDoc newer = doc;
  newer.j["asset"]["minVersion"] = "2.1";
  CHECK_THAT(refused(newer.save(folder)), Catch::Contains("it requires a reader of glTF 2.1; 2.0 is read"));
  for (const auto& [entry, value] : {std::pair(3, 0.5), {7, -0.1}, {11, 1}, {15, 2}, {15, 0}}) {
    GltfDoc bent = doc;
    bent.j["nodes"][0]["matrix"][static_cast<std::size_t>(entry)] = value;
    CHECK_THAT(refused(bent.save(folder)), Catch::Contains("the matrix of node 0 is no place"));
  }
  doc.j["nodes"][0]["matrix"][15] = 0.99999994;  // as a float may be written
  check_near(box_of(read(doc.save(folder)), 0), {5, 0, 0}, {6, 1, 1});
  doc.j["scenes"][0]["nodes"] = {0, 0};
  CHECK_THAT(refused(doc.save(folder)), Catch::Contains("scene 0 names node 0 twice"));
}

TEST_CASE("glTF: a buffer's file may lie in a folder below, its name written with percent signs", "[gltf]") {
  const TempFolder folder;
  GltfDoc doc;
  doc.node({{"mesh", doc.mesh(doc.tetrahedron())}});
  doc.save(folder);
  std::filesystem::create_directory(folder / "raw data");
  std::filesystem::rename(folder / "a.bin", folder / "raw data/b.bin");
  Json j = Json::parse(read_text(folder / "a.gltf"));
  for (const char* uri : {"raw%20data/b.bin", "raw data/b.bin", "./raw%20data/b.bin"}) {
    INFO(uri);
    j["buffers"][0]["uri"] = uri;
    folder.write("a.gltf", j.dump());
    check_near(box_of(read(folder / "a.gltf"), 0), Vec3::Zero(), Vec3::Ones());
  }
}

TEST_CASE("glTF: what lies in a buffer without data is refused, not read as zeros", "[gltf]") {
  const TempFolder folder;
  for (const bool fallback : {false, true}) {
    GltfDoc doc;
    doc.node({{"mesh", doc.mesh(doc.tetrahedron())}});
    Json empty = {{"byteLength", 96}};
    if (fallback) empty["extensions"] = {{"EXT_meshopt_compression", {{"fallback", true}}}};
    doc.j["buffers"] = Json::array({empty});
    CHECK(read(doc.save(folder)).parts.size() == 1);  // nobody uses it
    // A whole primitive, beside one that lacks its indices, its positions, or what a sparse accessor changes.
    const auto lacking = [&](const std::function<void(GltfDoc&, Json&)>& change) {
      GltfDoc bad = doc;
      Json second = bad.tetrahedron();
      change(bad, second);
      bad.j["meshes"][0]["primitives"].push_back(second);
      return refused(bad.save(folder));
    };
    const auto move = [](GltfDoc& bad, const Json& accessor) {
      Json& view = bad.j["bufferViews"][bad.j["accessors"][accessor.get<std::size_t>()]["bufferView"].get<int>()];
      view["buffer"] = 1;
      view["byteOffset"] = 0;
    };
    const char* const why = "mesh 0, primitive 1 (node 0): damaged: an accessor lies in a buffer that has no data";
    CHECK_THAT(lacking([&](GltfDoc& bad, Json& p) { move(bad, p["indices"]); }), Catch::Contains(why));
    CHECK_THAT(lacking([&](GltfDoc& bad, Json& p) { move(bad, p["attributes"]["POSITION"]); }), Catch::Contains(why));
    for (const char* part : {"indices", "values"}) {
      INFO(part);
      CHECK_THAT(lacking([&](GltfDoc& bad, Json& p) {
                   const std::size_t view = bad.view(std::string(12, '\0'));
                   Json sparse = {{"count", 1},
                                  {"indices", {{"bufferView", view}, {"componentType", 5121}}},
                                  {"values", {{"bufferView", view}}}};
                   bad.j["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 0}, {"byteLength", 12}});
                   sparse[part]["bufferView"] = view + 1;
                   bad.j["accessors"][p["indices"].get<std::size_t>()]["sparse"] = sparse;
                 }),
                 Catch::Contains(why));
    }
  }
}

TEST_CASE("glTF: indices are unsigned whole numbers, and lists of triangles have three for each", "[gltf]") {
  const TempFolder folder;
  const auto with = [&](const std::string& bytes, int type, std::size_t count, int mode = 4) {
    GltfDoc doc;
    Json more = {{"attributes", {{"POSITION", doc.corners()}}},
                 {"indices", doc.accessor(bytes, type, "SCALAR", count)},
                 {"mode", mode}};
    doc.node({{"mesh", doc.mesh(doc.tetrahedron())}});
    doc.j["meshes"][0]["primitives"].push_back(more);
    return doc.save(folder);
  };
  const char* const why = "indices are no unsigned whole numbers";
  CHECK_THAT(refused(with(GltfDoc::bytes_of<float>({0, 2, 1}), 5126, 3)), Catch::Contains(why));
  CHECK_THAT(refused(with(std::string({0, 2, 1}), 5120, 3)), Catch::Contains(why));
  CHECK_THAT(refused(with(GltfDoc::bytes_of<std::int16_t>({0, 2, 1}), 5122, 3)), Catch::Contains(why));
  for (const auto& [count, mode, told] : {std::tuple(5, 4, true),
                                          {4, 4, true},
                                          {6, 4, false},
                                          {2, 5, true},
                                          {4, 5, false},
                                          {1, 6, true},
                                          {4, 6, false},
                                          {2, 1, false}}) {
    INFO(count << " of mode " << mode);
    const Assembly a = read_assembly(with(std::string("\0\2\1\0\1\3", 6), 5121, static_cast<std::size_t>(count), mode));
    CHECK(has_note(a, "the last corners of 1 list of triangles") == told);
    CHECK(a.notes.size() == (told ? 1 : 0));
  }
}

TEST_CASE("glTF: elements that overlap are refused", "[gltf]") {
  const TempFolder folder;
  GltfDoc doc;
  doc.node({{"mesh", doc.mesh(doc.tetrahedron())}});
  doc.j["bufferViews"][0]["byteStride"] = 12;
  CHECK(read(doc.save(folder)).parts.size() == 1);
  doc.j["bufferViews"][0]["byteStride"] = 8;
  CHECK_THAT(refused(doc.save(folder)), Catch::Contains("the elements of accessor 0 overlap"));
}

TEST_CASE("glTF: the bytes say what a file is; numbers like 8.0 are whole", "[gltf]") {
  const TempFolder folder;
  GltfDoc doc;
  doc.node({{"mesh", doc.mesh(doc.tetrahedron())}});
  doc.j["accessors"][0]["count"] = 4.0;
  doc.save(folder);
  std::string text = read_text(folder / "a.gltf");
  const auto check = [&](const std::string& name, const std::string& bytes) {
    INFO(name);
    folder.write(name, bytes);
    check_near(box_of(read(folder / name), 0), Vec3::Zero(), Vec3::Ones());
  };
  check("text.glb", text);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto glb = [&](std::uint32_t version) {
    const auto size = static_cast<std::uint32_t>(text.size());
    return "glTF" + GltfDoc::bytes_of<std::uint32_t>({version, 20 + size, size}) + "JSON" + text;
  };
  check("binary.gltf", glb(2));
  folder.write("old.glb", glb(1));
  CHECK_THAT(refused(folder / "old.glb"), Catch::Contains("version 1 is not read"));
  const std::string uri = "\"uri\":\"a.bin\"";
  folder.write("percent.gltf", text.replace(text.find(uri), uri.size(), "\"uri\":\"data:,%00\""));
  CHECK_THAT(refused(folder / "percent.gltf"), Catch::Contains("not base64"));
}

TEST_CASE("glTF: triangles come as lists, strips and fans, with and without indices; points and lines go", "[gltf]") {
  const TempFolder folder;
  GltfDoc doc;
  std::vector<float> soup;
  const float c[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const int i : {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3}) soup.insert(soup.end(), c[i], c[i] + 3);
  doc.node({{"mesh", doc.mesh({{"attributes", {{"POSITION", doc.floats(soup, "VEC3", 3)}}}})}});
  // 0 2 1 3 goes on to 0 and 2: every face once, turned right.
  const std::size_t strip = doc.accessor(std::string({0, 2, 1, 3, 0, 2}), 5121, "SCALAR", 6);
  doc.node({{"mesh", doc.mesh({{"attributes", {{"POSITION", doc.corners()}}}, {"indices", strip}, {"mode", 5}})}});
  // Three faces round corner 3, and the one across.
  const std::size_t fan = doc.accessor(std::string({3, 0, 1, 2, 0}), 5121, "SCALAR", 5);
  const std::size_t rest = doc.accessor(std::string({0, 2, 1}), 5121, "SCALAR", 3);
  const std::size_t corners = doc.corners();
  const std::size_t both = doc.mesh({{"attributes", {{"POSITION", corners}}}, {"indices", fan}, {"mode", 6}});
  doc.j["meshes"][both]["primitives"].push_back({{"attributes", {{"POSITION", corners}}}, {"indices", rest}});
  doc.j["meshes"][both]["primitives"].push_back({{"attributes", {{"POSITION", corners}}}, {"mode", 0}});
  doc.j["meshes"][both]["primitives"].push_back({{"attributes", {{"POSITION", corners}}}, {"mode", 1}});
  doc.node({{"mesh", both}});
  const Assembly a = read(doc.save(folder));
  REQUIRE(a.parts.size() == 3);
  for (const AssemblyPart& part : a.parts) {
    CHECK(a.shapes[part.shape]->triangles.size() == 4);
    CHECK(volume(*a.shapes[part.shape]) == Approx(1.0 / 6));
  }
}

TEST_CASE("glTF: positions of integers mean what they stand for (KHR_mesh_quantization)", "[gltf]") {
  const auto check = [](auto one, int type, bool normalized, double scale) {
    using T = decltype(one);
    INFO(type << (normalized ? " normalized" : ""));
    GltfDoc doc;
    doc.uses("KHR_mesh_quantization");
    std::vector<T> rows;  // of four numbers: attributes begin at multiples of four bytes
    for (int corner = -1; corner < 3; ++corner)
      for (int k = 0; k < 4; ++k) rows.push_back(k == corner ? one : T{0});
    const std::size_t position = doc.accessor(GltfDoc::bytes_of(rows), type, "VEC3", 4);
    doc.j["bufferViews"].back()["byteStride"] = 4 * sizeof(T);
    doc.j["accessors"][position]["normalized"] = normalized;
    const Assembly a = read_with_position(doc, position, {{"scale", {scale, scale, scale}}});
    check_near(box_of(a, 0), Vec3::Zero(), Vec3::Ones());
  };
  check(std::int8_t{100}, 5120, false, 0.01);
  check(std::int8_t{127}, 5120, true, 1);
  check(std::uint8_t{200}, 5121, false, 0.005);
  check(std::uint8_t{255}, 5121, true, 1);
  check(std::int16_t{1000}, 5122, false, 0.001);
  check(std::int16_t{32767}, 5122, true, 1);
  check(std::uint16_t{50000}, 5123, false, 2e-5);
  check(std::uint16_t{65535}, 5123, true, 1);
}

TEST_CASE("glTF: the lowest of the normalized signed integers stands for -1, as the one above it", "[gltf]") {
  const auto check = [](auto lowest, int type) {
    using T = decltype(lowest);
    INFO(type);
    GltfDoc doc;
    doc.uses("KHR_mesh_quantization");
    const T highest = std::numeric_limits<T>::max();
    const auto add = [&](const std::vector<T>& rows) {
      const std::size_t accessor = doc.accessor(GltfDoc::bytes_of(rows), type, "VEC3", 4);
      doc.j["bufferViews"].back()["byteStride"] = 4 * sizeof(T);
      doc.j["accessors"][accessor]["normalized"] = true;
      return accessor;
    };
    std::vector<T> rows;
    for (int corner = -1; corner < 3; ++corner)
      for (int k = 0; k < 4; ++k) rows.push_back(k == corner ? highest : lowest);
    const std::size_t position = add(rows), shift = add(std::vector<T>(16, lowest));
    Json primitive = {{"attributes", {{"POSITION", position}}}, {"indices", doc.faces()}};
    doc.node({{"mesh", doc.mesh(primitive)}});
    primitive["targets"] = {{{"POSITION", shift}}};
    doc.node({{"mesh", doc.mesh(primitive)}, {"weights", {1}}});
    // A sparse accessor of nothing but zeros, and what it changes: the mesh's own positions.
    doc.j["accessors"].push_back(doc.j["accessors"][position]);
    Json& sparse = doc.j["accessors"].back();
    const std::size_t all = doc.view(std::string({0, 1, 2, 3}));
    std::vector<T> tight;
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (i % 4 != 3) tight.push_back(rows[i]);
    sparse["sparse"] = {{"count", 4},
                        {"indices", {{"bufferView", all}, {"componentType", 5121}}},
                        {"values", {{"bufferView", doc.view(GltfDoc::bytes_of(tight))}}}};
    sparse.erase("bufferView");
    primitive.erase("targets");
    primitive["attributes"]["POSITION"] = doc.j["accessors"].size() - 1;
    doc.node({{"mesh", doc.mesh(primitive)}});
    const TempFolder folder;
    const Assembly a = read(doc.save(folder));
    REQUIRE(a.parts.size() == 3);
    for (const std::size_t plain : {0u, 2u}) check_near(box_of(a, plain), -Vec3::Ones(), Vec3::Ones());
    check_near(box_of(a, 1), Vec3::Constant(-2), Vec3::Zero());
  };
  check(std::int8_t{-128}, 5120);
  check(std::int16_t{-32768}, 5122);
}

TEST_CASE("glTF: sparse accessors", "[gltf]") {
  const auto sparse = [](GltfDoc& doc, std::uint8_t element) {
    const std::size_t position = doc.corners();
    doc.j["accessors"][position]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", doc.view(std::string(1, static_cast<char>(element)))}, {"componentType", 5121}}},
        {"values", {{"bufferView", doc.view(GltfDoc::bytes_of(std::vector<float>{0, 0, 7}))}}}};
    return position;
  };
  GltfDoc doc;
  check_near(box_of(read_with_position(doc, sparse(doc, 3)), 0), Vec3::Zero(), {1, 1, 7});
  const TempFolder folder;
  GltfDoc beyond;
  beyond.node(
      {{"mesh", beyond.mesh({{"attributes", {{"POSITION", sparse(beyond, 4)}}}, {"indices", beyond.faces()}})}});
  CHECK_THAT(refused(beyond.save(folder)), Catch::Contains("index out of range: a sparse accessor"));
}

TEST_CASE("glTF: sparse indices", "[gltf]") {
  const TempFolder folder;
  GltfDoc doc;
  const std::size_t corners = doc.corners(), indices = doc.faces();
  // The last face is a wrong one that the sparse part puts right.
  const std::size_t last = doc.view(std::string({9, 10, 11})), right = doc.view(std::string({2, 0, 0, 0, 3, 0}));
  const std::size_t wrong = doc.accessor(
      GltfDoc::bytes_of(std::vector<std::uint16_t>{0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 0, 0}), 5123, "SCALAR", 12);
  doc.j["accessors"][wrong]["sparse"] = {
      {"count", 3}, {"indices", {{"bufferView", last}, {"componentType", 5121}}}, {"values", {{"bufferView", right}}}};
  doc.node({{"mesh", doc.mesh({{"attributes", {{"POSITION", corners}}}, {"indices", wrong}})}});
  // Of nothing but zeros, all of them changed.
  Json bare = doc.j["accessors"][indices];
  const std::size_t all = doc.view(std::string({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
  bare["sparse"] = {{"count", 12},
                    {"indices", {{"bufferView", all}, {"componentType", 5121}}},
                    {"values", {{"bufferView", bare["bufferView"]}}}};
  bare.erase("bufferView");
  doc.j["accessors"].push_back(bare);
  doc.node({{"mesh", doc.mesh({{"attributes", {{"POSITION", corners}}}, {"indices", doc.j["accessors"].size() - 1}})}});
  const Assembly a = read(doc.save(folder));
  REQUIRE(a.parts.size() == 2);
  for (const auto& shape : a.shapes) CHECK(volume(*shape) == Approx(1.0 / 6));
}

TEST_CASE("glTF: morph weights of the node, or of the mesh, pose it", "[gltf]") {
  const TempFolder folder;
  GltfDoc doc;
  Json primitive = doc.tetrahedron();
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<float> shift(12, 0);
    shift[static_cast<std::size_t>(9 + axis)] = 4;  // of the tip
    primitive["targets"].push_back({{"POSITION", doc.floats(shift, "VEC3", 3)}});
  }
  const std::size_t mesh = doc.mesh(primitive);
  doc.j["meshes"][mesh]["weights"] = {0.5, 0};
  doc.node({{"mesh", mesh}});
  doc.node({{"mesh", mesh}, {"weights", {0, 1}}});
  const Assembly a = read(doc.save(folder));
  REQUIRE(a.parts.size() == 2);
  check_near(box_of(a, 0), Vec3::Zero(), {2, 1, 1});
  check_near(box_of(a, 1), Vec3::Zero(), {1, 4, 1});
}

TEST_CASE("glTF: a skin poses its mesh, whose node's own place does not count", "[gltf]") {
  const TempFolder folder;
  GltfDoc doc;
  Json primitive = doc.tetrahedron();
  // Three corners hang on joint 0, the tip half on each.
  primitive["attributes"]["JOINTS_0"] =
      doc.accessor(std::string({0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}), 5121, "VEC4", 4);
  primitive["attributes"]["WEIGHTS_0"] = doc.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, .5f, .5f, 0, 0}, "VEC4", 4);
  const std::size_t mesh = doc.mesh(primitive);
  const std::size_t far = doc.node({{"name", "far"}, {"translation", {0, 0, 6}}}, false);
  const std::size_t near = doc.node({{"name", "near"}, {"translation", {10, 0, 0}}, {"children", {far}}});
  doc.j["skins"] = {{{"joints", {near, far}}}};
  doc.node({{"mesh", mesh}, {"skin", 0}, {"translation", {100, 100, 100}}});
  check_near(box_of(read(doc.save(folder)), 0), {10, 0, 0}, {11, 1, 4});
  // Inverse bind matrices that take the joints' places back: the mesh as it is.
  doc.j["skins"][0]["inverseBindMatrices"] =
      doc.floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -10, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -10, 0, -6, 1},
                 "MAT4", 16);
  check_near(box_of(read(doc.save(folder)), 0), Vec3::Zero(), Vec3::Ones());
  doc.j["skins"][0]["joints"] = {near};
  CHECK_THAT(refused(doc.save(folder)), Catch::Contains("a vertex names a joint"));
  doc.j["skins"][0] = {{"joints", {near, far}},
                       {"inverseBindMatrices", doc.floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,  //
                                                           1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                                                          "MAT4", 16)}};
  CHECK_THAT(refused(doc.save(folder)), Catch::Contains("an inverse bind matrix is no place"));
}

TEST_CASE("glTF: weights of a skin count as shares of their sum, and are told when that is not one", "[gltf]") {
  const auto posed = [](const std::vector<float>& weights) {
    const TempFolder folder;
    GltfDoc doc;
    Json primitive = doc.tetrahedron();
    primitive["attributes"]["JOINTS_0"] = doc.accessor(std::string(16, '\0'), 5121, "VEC4", 4);
    primitive["attributes"]["WEIGHTS_0"] = doc.floats(weights, "VEC4", 4);
    const std::size_t joint = doc.node({{"translation", {10, 0, 0}}}, false);
    doc.j["skins"] = {{{"joints", {joint}}}};
    doc.node({{"mesh", doc.mesh(primitive)}, {"skin", 0}});
    return read(doc.save(folder));
  };
  const Assembly off = posed({2, 0, 0, 0, .5f, 0, 0, 0, .25f, .25f, 0, 0, 1, 0, 0, 0});
  check_near(box_of(off, 0), {10, 0, 0}, {11, 1, 1});
  CHECK(has_note(off, "the weights of 3 vertices"));
  const Assembly rounded = posed({.998f, 0, 0, 0, .333f, .333f, .333f, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  check_near(box_of(rounded, 0), {10, 0, 0}, {11, 1, 1});
  CHECK(rounded.notes.empty());
  CHECK_THAT(test::refusal([&] { posed(std::vector<float>(16, 0)); }), Catch::Contains("hangs on no joint"));
}

TEST_CASE("glTF: instances (EXT_mesh_gpu_instancing)", "[gltf]") {
  const TempFolder folder;
  GltfDoc doc;
  doc.uses("EXT_mesh_gpu_instancing");
  const Json places = {{"TRANSLATION", doc.floats({0, 0, 0, 5, 0, 0, 0, 0, 7}, "VEC3", 3)},
                       {"ROTATION", doc.floats({0, 0, 0, 1, 0, 0, 0.70710678f, 0.70710678f, 0, 0, 0, 1}, "VEC4", 4)},
                       {"SCALE", doc.floats({1, 1, 1, 1, 1, 1, 2, 2, 2}, "VEC3", 3)}};
  doc.node({{"mesh", doc.mesh(doc.tetrahedron())},
            {"translation", {100, 0, 0}},
            {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", places}}}}}});
  const Assembly a = read(doc.save(folder));
  REQUIRE(a.parts.size() == 3);
  check_near(box_of(a, 0), {100, 0, 0}, {101, 1, 1});
  check_near(box_of(a, 1), {104, 0, 0}, {105, 1, 1});
  check_near(box_of(a, 2), {100, 0, 7}, {102, 2, 9});
  CHECK(a.parts[0].shape == a.parts[1].shape);
}

TEST_CASE("glTF: extensions that are not read refuse the file when required, and are told when used", "[gltf]") {
  const TempFolder folder;
  GltfDoc doc;
  doc.node({{"mesh", doc.mesh(doc.tetrahedron())}});
  doc.uses("KHR_materials_unlit");
  CHECK(read(doc.save(folder)).notes.empty());
  doc.uses("ACME_bends", false);
  CHECK(has_note(read(doc.save(folder)), "ACME_bends is not read"));
  doc.uses("ACME_bends");
  CHECK_THAT(refused(doc.save(folder)), Catch::Contains("requires the glTF extension ACME_bends"));
}

TEST_CASE("glTF: animations are told, cameras and lights are nothing", "[gltf]") {
  const TempFolder folder;
  GltfDoc doc;
  doc.node({{"mesh", doc.mesh(doc.tetrahedron())}});
  doc.j["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  doc.node({{"camera", 0}});
  CHECK(read(doc.save(folder)).notes.empty());
  const std::size_t times = doc.floats({0, 1}, "SCALAR", 1), places = doc.floats({0, 0, 0, 9, 9, 9}, "VEC3", 3);
  doc.j["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
                          {"samplers", {{{"input", times}, {"output", places}}}}}};
  const Assembly a = read(doc.save(folder));
  check_near(box_of(a, 0), Vec3::Zero(), Vec3::Ones());
  CHECK(has_note(a, "animations"));
}

TEST_CASE("glTF: Draco (KHR_draco_mesh_compression)", "[gltf]") {
  const TempFolder folder;
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(4);
  const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const float c[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  for (int f = 0; f < 4; ++f)
    builder.SetAttributeValuesForFace(id, draco::FaceIndex(static_cast<std::uint32_t>(f)), c[faces[f][0]],
                                      c[faces[f][1]], c[faces[f][2]]);
  const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
  draco::Encoder encoder;
  draco::EncoderBuffer packed;
  REQUIRE(encoder.EncodeMeshToBuffer(*mesh, &packed).ok());
  GltfDoc doc;
  doc.uses("KHR_draco_mesh_compression");
  doc.j["accessors"] = {{{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
                        {{"componentType", 5123}, {"count", 12}, {"type", "SCALAR"}}};
  const std::size_t view = doc.view(std::string(packed.data(), packed.size()));
  doc.node(
      {{"mesh",
        doc.mesh({{"attributes", {{"POSITION", 0}}},
                  {"indices", 1},
                  {"extensions",
                   {{"KHR_draco_mesh_compression", {{"bufferView", view}, {"attributes", {{"POSITION", 0}}}}}}}})}});
  const Assembly a = read(doc.save(folder));
  CHECK(volume(*a.shapes[0]) == Approx(1.0 / 6));
  const auto refused_for = [&](const GltfDoc& posed) {
    CHECK_THAT(refused(posed.save(folder)), Catch::Contains("compressed by Draco with a skin or morph targets"));
  };
  GltfDoc skinned = doc, morphed = doc;
  skinned.j["skins"] = {{{"joints", {skinned.node(Json::object())}}}};
  skinned.j["nodes"][0]["skin"] = 0;
  refused_for(skinned);
  morphed.j["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", morphed.corners()}}};
  refused_for(morphed);
  doc.j["bufferViews"][view]["byteLength"] = packed.size() / 2;
  CHECK_THAT(refused(doc.save(folder)), Catch::Contains("Draco is not a stream of it"));
}

TEST_CASE("glTF: integers compressed by Draco stand for what their accessor says", "[gltf]") {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(4);
  const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_INT16);
  const std::int16_t c[4][3] = {{0, 0, 0}, {32767, 0, 0}, {0, 32767, 0}, {0, 0, -32768}};  // normalized: -1 too
  const int faces[4][3] = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  for (int f = 0; f < 4; ++f)
    builder.SetAttributeValuesForFace(id, draco::FaceIndex(static_cast<std::uint32_t>(f)), c[faces[f][0]],
                                      c[faces[f][1]], c[faces[f][2]]);
  draco::Encoder encoder;
  draco::EncoderBuffer packed;
  REQUIRE(encoder.EncodeMeshToBuffer(*builder.Finalize(), &packed).ok());
  for (const bool normalized : {true, false}) {
    const TempFolder folder;
    GltfDoc doc;
    doc.uses("KHR_draco_mesh_compression");
    doc.uses("KHR_mesh_quantization");
    doc.j["accessors"] = {{{"componentType", 5122}, {"count", 4}, {"type", "VEC3"}, {"normalized", normalized}},
                          {{"componentType", 5123}, {"count", 12}, {"type", "SCALAR"}}};
    const Json stream = {{"bufferView", doc.view(std::string(packed.data(), packed.size()))},
                         {"attributes", {{"POSITION", 0}}}};
    const double size = normalized ? 1 : 1.0 / 32767;
    doc.node({{"mesh", doc.mesh({{"attributes", {{"POSITION", 0}}},
                                 {"indices", 1},
                                 {"extensions", {{"KHR_draco_mesh_compression", stream}}}})},
              {"scale", {size, size, size}}});
    check_near(box_of(read(doc.save(folder)), 0), {0, 0, normalized ? -1 : -32768.0 / 32767}, {1, 1, 0});
  }
}

TEST_CASE("glTF: meshoptimizer (EXT_meshopt_compression)", "[gltf]") {
  const TempFolder folder;
  const std::vector<float> corners = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::vector<std::uint32_t> faces = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
  const auto vertices = [&](const void* data, std::size_t stride) {
    std::string out(meshopt_encodeVertexBufferBound(4, stride), '\0');
    out.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(), data, 4, stride));
    return out;
  };
  std::string triangles(meshopt_encodeIndexBufferBound(12, 4), '\0'),
      sequence(meshopt_encodeIndexSequenceBound(12, 4), '\0');
  triangles.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(triangles.data()), triangles.size(),
                                             faces.data(), 12));
  sequence.resize(meshopt_encodeIndexSequence(reinterpret_cast<unsigned char*>(sequence.data()), sequence.size(),
                                              faces.data(), 12));
  // A number is 24 bits times two to the power of 8 bits.
  const std::vector<std::uint32_t> exponential(corners.begin(), corners.end());
  const auto file = [&](const std::string& positions, const char* filter, const std::string& indices,
                        const char* mode) {
    GltfDoc doc;
    doc.uses("EXT_meshopt_compression");
    const std::string packed = positions + indices;
    doc.view(packed);
    doc.j["bufferViews"] = Json::array();
    doc.j["buffers"] = nlohmann::json::array(
        {{{"byteLength", 96}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}});
    const auto view = [&](std::size_t at, std::size_t offset, std::size_t bytes, std::size_t stride, std::size_t count,
                          const char* how, const char* with) {
      doc.j["bufferViews"].push_back({{"buffer", 1},
                                      {"byteOffset", at},
                                      {"byteLength", count * stride},
                                      {"extensions",
                                       {{"EXT_meshopt_compression",
                                         {{"buffer", 0},
                                          {"byteOffset", offset},
                                          {"byteLength", bytes},
                                          {"byteStride", stride},
                                          {"count", count},
                                          {"mode", how},
                                          {"filter", with}}}}}});
    };
    view(0, 0, positions.size(), 12, 4, "ATTRIBUTES", filter);
    view(48, positions.size(), indices.size(), 4, 12, mode, "NONE");
    doc.j["accessors"] = {{{"bufferView", 0}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
                          {{"bufferView", 1}, {"componentType", 5125}, {"count", 12}, {"type", "SCALAR"}}};
    doc.node({{"mesh", doc.mesh({{"attributes", {{"POSITION", 0}}}, {"indices", 1}})}});
    return doc;
  };
  const std::string plain = vertices(corners.data(), 12);
  for (const GltfDoc& doc : {file(plain, "NONE", triangles, "TRIANGLES"), file(plain, "NONE", sequence, "INDICES"),
                             file(vertices(exponential.data(), 12), "EXPONENTIAL", triangles, "TRIANGLES")}) {
    const Assembly a = read(doc.save(folder));
    CHECK(volume(*a.shapes[0]) == Approx(1.0 / 6));
  }
  GltfDoc damaged = file(plain, "NONE", triangles, "TRIANGLES");
  damaged.j["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["byteLength"] = plain.size() - 1;
  CHECK_THAT(refused(damaged.save(folder)), Catch::Contains("not a stream of EXT_meshopt_compression"));
  for (const auto& [key, value] : {std::pair("byteStride", 13), {"count", 5}, {"byteLength", 4000}}) {
    damaged.j["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][key] = value;
    CHECK_THAT(refused(damaged.save(folder)), Catch::Contains("no sizes that EXT_meshopt_compression allows"));
  }
}

TEST_CASE("glTF: what meshoptimizer filters: directions and rotations", "[gltf]") {
  const auto add = [](GltfDoc& doc, const void* data, std::size_t count, std::size_t stride, const char* filter,
                      const char* shape, int type) {
    std::string stream(meshopt_encodeVertexBufferBound(count, stride), '\0');
    stream.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(stream.data()), stream.size(), data,
                                             count, stride));
    const std::size_t accessor = doc.accessor(stream, type, shape, count);
    doc.j["accessors"][accessor]["normalized"] = true;
    Json& view = doc.j["bufferViews"].back();
    const Json from = {{"buffer", 0},
                       {"byteOffset", view["byteOffset"]},
                       {"byteLength", stream.size()},
                       {"byteStride", stride},
                       {"count", count},
                       {"mode", "ATTRIBUTES"},
                       {"filter", filter}};
    view = {{"buffer", 1},
            {"byteOffset", 0},
            {"byteLength", count * stride},
            {"byteStride", stride},
            {"extensions", {{"EXT_meshopt_compression", from}}}};
    return accessor;
  };
  const auto begun = [] {
    GltfDoc doc;
    for (const char* extension : {"EXT_meshopt_compression", "KHR_mesh_quantization", "EXT_mesh_gpu_instancing"})
      doc.uses(extension);
    doc.j["buffers"] =
        Json::array({{{"byteLength", 96}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}});
    return doc;
  };
  const TempFolder folder;
  // A regular tetrahedron, its corners on the unit sphere; the filter keeps directions in bytes or in shorts.
  const float s = std::sqrt(1.0f / 3);
  const std::vector<float> corners = {s, s, s, 0, s, -s, -s, 0, -s, s, -s, 0, -s, -s, s, 0};
  for (const auto& [stride, within] : {std::pair(4, 0.02), {8, 2e-4}}) {
    INFO(stride);
    const auto bytes = static_cast<std::size_t>(stride);
    std::string packed(4 * bytes, '\0');
    meshopt_encodeFilterOct(packed.data(), 4, bytes, stride == 4 ? 8 : 16, corners.data());
    GltfDoc doc = begun();
    const std::size_t position = add(doc, packed.data(), 4, bytes, "OCTAHEDRAL", "VEC3", stride == 4 ? 5120 : 5122);
    const std::size_t faces = doc.accessor(std::string({0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2}), 5121, "SCALAR", 12);
    doc.node({{"mesh", doc.mesh({{"attributes", {{"POSITION", position}}}, {"indices", faces}})}});
    const Assembly a = read(doc.save(folder));
    CHECK(volume(*a.shapes[0]) == Approx(8 * std::sqrt(3.0) / 27).epsilon(within));
    check_box(box_of(a, 0), Vec3::Constant(-s), Vec3::Constant(s), 2 * within);
  }
  // Turns of nothing, a quarter about z, and a half about x.
  const float r = std::sqrt(0.5f);
  const std::vector<float> turns = {0, 0, 0, 1, 0, 0, r, r, 1, 0, 0, 0};
  std::string packed(24, '\0');
  meshopt_encodeFilterQuat(packed.data(), 3, 8, 16, turns.data());
  GltfDoc doc = begun();
  const Json places = {{"TRANSLATION", doc.floats({0, 0, 0, 5, 0, 0, 0, 0, 7}, "VEC3", 3)},
                       {"ROTATION", add(doc, packed.data(), 3, 8, "QUATERNION", "VEC4", 5122)}};
  doc.node(
      {{"mesh", doc.mesh(doc.tetrahedron())}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", places}}}}}});
  const Assembly a = read(doc.save(folder));
  REQUIRE(a.parts.size() == 3);
  check_box(box_of(a, 0), Vec3::Zero(), Vec3::Ones(), 1e-3);
  check_box(box_of(a, 1), {4, 0, 0}, {5, 1, 1}, 1e-3);
  check_box(box_of(a, 2), {0, -1, 6}, {1, 0, 7}, 1e-3);
}

TEST_CASE("glTF: another unit scales meshes and places; names that a program made up give way to the mesh's",
          "[gltf]") {
  const TempFolder folder;
  GltfDoc doc;
  const std::size_t mesh = doc.mesh(doc.tetrahedron());  // "tip"
  doc.j["meshes"].push_back(doc.j["meshes"][mesh]);
  doc.j["meshes"].back()["name"] = "Mesh_7";
  doc.node({{"mesh", mesh}, {"name", "Node_12"}});
  doc.node({{"mesh", mesh}, {"name", "Kolben"}, {"translation", {3, 0, 0}}});
  doc.node({{"mesh", mesh + 1}, {"name", "Object 4"}, {"translation", {6, 0, 0}}});
  doc.node({{"mesh", mesh}, {"name", ""}, {"translation", {700, 0, 0}}});
  const std::string file = doc.save(folder);
  CHECK(test::refusal(file).find("701 m across") != std::string::npos);
  AssemblyOptions millimeters;
  millimeters.unit = "mm";
  const Assembly a = read_assembly(file, millimeters);
  REQUIRE(a.parts.size() == 4);
  CHECK(a.parts[0].name == "tip");
  CHECK(a.parts[1].name == "Kolben");
  CHECK(a.parts[2].name == "Object 4");
  CHECK(a.parts[3].name == "tip_2");
  CHECK((a.parts[1].pose.p - Vec3(3e-3, 0, 0)).norm() < 1e-12);
  CHECK((report(*a.shapes[a.parts[1].shape]).box_max - Vec3(1e-3, 1e-3, 1e-3)).norm() < 1e-9);
}
