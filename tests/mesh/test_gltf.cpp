// What a glTF file says of its parts: nodes, scenes, poses, names, extensions; see the rows of docs/formats.md.

#include "mesh/gltf_checks.hpp"

using namespace tegotae;
using namespace tegotae::test;

TEST_CASE("GLB: a chunk that is neither JSON nor binary is not a buffer", "[gltf]") {
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
  doc.j["nodes"][0]["skin"] = 0;
  CHECK_THAT(refused(doc.save(folder)), Catch::Contains("skin 0 names nodes 7 of 2"));
  doc.j.erase("skins");
  doc.j["nodes"][0].erase("skin");
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
    CHECK_THAT(refused(bent.save(folder)), Catch::Contains("the matrix of node 0 is not a pose"));
  }
  doc.j["nodes"][0]["matrix"][15] = 0.99999994;  // as a float may be written
  check_near(box_of(read(doc.save(folder)), 0), {5, 0, 0}, {6, 1, 1});
  doc.j["scenes"][0]["nodes"] = {0, 0};
  CHECK_THAT(refused(doc.save(folder)), Catch::Contains("scene 0 names node 0 twice"));
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
  CHECK_THAT(refused(doc.save(folder)), Catch::Contains("an inverse bind matrix is not a pose"));
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
