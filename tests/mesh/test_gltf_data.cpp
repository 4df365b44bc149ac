// The numbers of a glTF file: buffers, accessors, triangles; see the rows of docs/formats.md.
#include <filesystem>
#include <functional>
#include <limits>

#include "mesh/gltf_checks.hpp"

using namespace tegotae;
using namespace tegotae::test;

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
  const char* const why = "indices are not unsigned whole numbers";
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

TEST_CASE("glTF: what is wrong with neither shape nor place refuses no file", "[gltf]") {
  const TempFolder folder;
  const auto with = [&](const std::function<void(GltfDoc&, Json&)>& spoil) {
    GltfDoc doc;
    Json primitive = doc.tetrahedron();
    spoil(doc, primitive);
    doc.node({{"mesh", doc.mesh(primitive)}, {"camera", 9}});
    return doc;
  };
  const std::vector<std::pair<const char*, std::function<void(GltfDoc&, Json&)>>> spoils = {
      {"texture",
       [](GltfDoc& doc, Json& primitive) {
         doc.j["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 7}}}}}}};
         primitive["material"] = 0;
       }},
      {"image",
       [](GltfDoc& doc, Json&) {
         doc.j["textures"] = {{{"source", 5}, {"sampler", 6}}};
         doc.j["images"] = {{{"bufferView", 77}, {"mimeType", "image/png"}}};
       }},
      {"light",
       [](GltfDoc& doc, Json&) {
         doc.uses("KHR_lights_punctual");
         doc.node({{"extensions", {{"KHR_lights_punctual", {{"light", 3}}}}}});
       }},
      {"attributes",
       [](GltfDoc& doc, Json& primitive) {
         doc.j["accessors"].push_back({{"bufferView", 0}, {"componentType", 5126}, {"count", 999}, {"type", "VEC2"}});
         primitive["attributes"]["TEXCOORD_0"] = doc.j["accessors"].size() - 1;
         primitive["attributes"]["NORMAL"] = 88;
         primitive["targets"] = {{{"NORMAL", 88}}};
       }},
      {"data that nobody names",
       [](GltfDoc& doc, Json&) {
         doc.j["bufferViews"].push_back({{"buffer", 44}, {"byteLength", 1}});
         doc.j["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 123456789}});
         doc.j["accessors"].push_back({{"bufferView", 55}, {"componentType", 1}, {"count", 3}, {"type", "VEC9"}});
         doc.j["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", 66}}}}}}});
         doc.j["skins"].push_back({{"joints", {55}}});
         doc.j["scenes"].push_back({{"nodes", {99}}});
       }},
      {"the file of a picture's buffer", [](GltfDoc& doc, Json&) {
         doc.j["buffers"] = {{{"byteLength", 10}, {"uri", "missing.bin"}}};
         doc.j["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 10}});
         doc.j["images"] = {{{"bufferView", doc.j["bufferViews"].size() - 1}, {"mimeType", "image/png"}}};
       }}};
  for (const auto& [name, spoil] : spoils) {
    INFO(name);
    const Assembly a = read(with(spoil).save(folder));
    REQUIRE(a.parts.size() == 1);
    check_near(box_of(a, 0), Vec3::Zero(), Vec3::Ones());
    CHECK(a.notes.empty());
  }
  const Assembly moving = read(with([](GltfDoc& doc, Json&) {
                                 doc.j["animations"] = {{{"channels", {{{"sampler", 5}, {"target", {{"node", 99}}}}}},
                                                         {"samplers", {{{"input", 70}, {"output", 80}}}}}};
                               }).save(folder));
  CHECK(has_note(moving, "animations"));
  const Assembly pale = read(with([](GltfDoc&, Json& primitive) { primitive["material"] = 4; }).save(folder));
  REQUIRE(pale.parts.size() == 1);
  CHECK(!pale.parts[0].color);
  CHECK(has_note(pale, "colors of materials"));
  // What the shape is made of still has to be there.
  CHECK_THAT(refused(with([](GltfDoc&, Json& primitive) { primitive["indices"] = 88; }).save(folder)),
             Catch::Contains("names accessors 88 of"));
}
