// glTF compressed by Draco and meshoptimizer.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include <cmath>

#include "mesh/gltf_checks.hpp"

using namespace tegotae;
using namespace tegotae::test;

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
