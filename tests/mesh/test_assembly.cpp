// Assemblies from glTF written by hand, and flat files with and without splitting.
#include <cmath>
#include <cstring>
#include <filesystem>

#include "apps/run_program.hpp"
#include "mesh/assembly_checks.hpp"
#include "models/shapes.hpp"
#include "tegotae/import/load.hpp"
#include "tegotae/import/write.hpp"
#include "text.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

template <typename T>
void put(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

/// A buffer of a box (36 indices, 8 vertices) and of a tetrahedron (12, 4), in m.
std::string buffer() {
  std::string bytes;
  const TriangleMesh box = shapes::box({0.02, 0.04, 0.06});
  REQUIRE(box.triangles.size() == 12);
  REQUIRE(box.vertices.size() == 8);
  for (const auto& t : box.triangles)
    for (const std::uint32_t v : t) put(bytes, v);
  for (const Vec3& p : box.vertices)
    for (int k = 0; k < 3; ++k) put(bytes, static_cast<float>(p[k]));
  for (const std::uint32_t v : {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2}) put(bytes, v);
  for (const float x : {0.f, 0.f, 0.f, .01f, 0.f, 0.f, 0.f, .01f, 0.f, 0.f, 0.f, .01f}) put(bytes, x);
  return bytes;
}

const char* const kTop = R"({"asset":{"version":"2.0"},"scene":0,
"buffers":[{"byteLength":336,"uri":"data.bin"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":144},{"buffer":0,"byteOffset":144,"byteLength":96},
 {"buffer":0,"byteOffset":240,"byteLength":48},{"buffer":0,"byteOffset":288,"byteLength":48}],
"accessors":[{"bufferView":0,"componentType":5125,"count":36,"type":"SCALAR"},
 {"bufferView":1,"componentType":5126,"count":8,"type":"VEC3","min":[-0.01,-0.02,-0.03],"max":[0.01,0.02,0.03]},
 {"bufferView":2,"componentType":5125,"count":12,"type":"SCALAR"},
 {"bufferView":3,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[0.01,0.01,0.01]}],
"materials":[{"name":"blau","pbrMetallicRoughness":{"baseColorFactor":[0.0,0.5,1.0,0.25]}}],
"meshes":[{"name":"Quader","primitives":[{"attributes":{"POSITION":1},"indices":0,"material":0}]},
 {"name":"Spitze","primitives":[{"attributes":{"POSITION":3},"indices":2}]}],
)";

// Gehäuse: turned by 90 degrees about z and moved by 1 m in x; in it two boxes, one of double size, and a tip.
const char* const kNodes = R"("scenes":[{"nodes":[0,4]}],
"nodes":[{"name":"Gehäuse","rotation":[0,0,0.70710678,0.70710678],"translation":[1,0,0],"children":[1,2,3]},
 {"name":"Stein","mesh":0,"translation":[0.1,0,0]},
 {"name":"Stein","mesh":0,"translation":[0.2,0,0],"rotation":[0.70710678,0,0,0.70710678]},
 {"name":"groß","mesh":0,"scale":[2,2,2]},
 {"name":"Stein_2","mesh":1,"scale":[-1,1,1]}]})";

void write_gltf(const TempFolder& folder, const std::string& nodes = kNodes, const std::string& top = kTop) {
  folder.write("data.bin", buffer());
  folder.write("a.gltf", top + nodes);
}

std::string glb(const std::string& nodes) {
  std::string json = std::string(kTop) + nodes;
  const std::string uri = R"(,"uri":"data.bin")";
  json.erase(json.find(uri), uri.size());
  while (json.size() % 4 != 0) json.push_back(' ');
  const std::string data = buffer();
  std::string out = "glTF";
  put(out, std::uint32_t{2});
  put(out, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + data.size()));
  put(out, static_cast<std::uint32_t>(json.size()));
  out += "JSON" + json;
  put(out, static_cast<std::uint32_t>(data.size()));
  return out + std::string("BIN\0", 4) + data;
}

}  // namespace

TEST_CASE("a glTF tree keeps names, groups, instances, places and colors", "[assembly]") {
  const TempFolder folder;
  write_gltf(folder);
  folder.write("b.glb", glb(kNodes));
  for (const char* file : {"a.gltf", "b.glb"}) {
    INFO(file);
    const Assembly a = read_assembly(folder / file);
    CHECK(a.unit == "m");
    CHECK(a.up == UpAxis::y);
    REQUIRE(a.parts.size() == 4);
    CHECK(a.parts[0].name == "Stein");
    CHECK(a.parts[1].name == "Stein_3");  // Stein_2 is taken
    CHECK(a.parts[2].name == "groß");
    CHECK(a.parts[3].name == "Stein_2");
    CHECK(a.parts[0].path == std::vector<std::string>{"Gehäuse"});
    CHECK(a.parts[3].path.empty());
    REQUIRE(a.shapes.size() == 3);  // the large one is a shape of its own
    CHECK(a.parts[0].shape == a.parts[1].shape);
    CHECK(a.parts[0].shape != a.parts[2].shape);
    // A quarter turn about z, then 1 m in x; 0.1 um of single precision.
    CHECK((a.parts[0].pose.p - Vec3(1, 0.1, 0)).norm() < 2e-7);
    CHECK((a.parts[1].pose.p - Vec3(1, 0.2, 0)).norm() < 2e-7);
    CHECK((a.parts[0].pose.q * Vec3(1, 0, 0) - Vec3(0, 1, 0)).norm() < 1e-6);
    CHECK((a.parts[1].pose.q * Vec3(0, 1, 0) - Vec3(0, 0, 1)).norm() < 1e-6);
    CHECK(volume(*a.shapes[a.parts[0].shape]) == Approx(0.02 * 0.04 * 0.06));
    CHECK(volume(*a.shapes[a.parts[2].shape]) == Approx(8 * 0.02 * 0.04 * 0.06));
    // Mirrored, so turned inside out twice: still right side out.
    const TriangleMesh& tip = *a.shapes[a.parts[3].shape];
    CHECK(volume(tip) == Approx(1e-6 / 6));
    double least = 0;
    for (const Vec3& p : tip.vertices) least = std::min(least, (a.parts[3].pose * p).x());
    CHECK(least == Approx(-0.01));
    REQUIRE(a.parts[0].color);
    CHECK((*a.parts[0].color)[0] == 0);
    CHECK((*a.parts[0].color)[1] == Approx(0.735357).epsilon(1e-5));  // sRGB of linear 0.5
    CHECK((*a.parts[0].color)[3] == 0.25);
    CHECK(!a.parts[3].color);
  }
}

TEST_CASE("broken glTF files are refused in one line", "[assembly]") {
  const TempFolder folder;
  write_gltf(folder);
  const auto refused = [&](const std::string& file, const std::string& why) {
    const std::string error = refusal(folder / file);
    INFO(file << ": " << error);
    CHECK(error.find(file + ": ") != std::string::npos);
    CHECK(error.find(why) != std::string::npos);
    CHECK(error.find('\n') == std::string::npos);
  };
  const std::string whole = glb(kNodes);
  for (std::size_t n = 0; n < whole.size(); n += 7) {
    folder.write("cut.glb", whole.substr(0, n));
    refused("cut.glb", "");
  }
  const std::string text = read_text(folder / "a.gltf");
  for (std::size_t n = 0; n + 1 < text.size(); n += 13) {
    folder.write("cut.gltf", text.substr(0, n));
    refused("cut.gltf", "");
  }
  const std::pair<const char*, const char*> nodes[] = {
      {R"("scenes":[{"nodes":[0]}],"nodes":[{"children":[1]},{"children":[0],"mesh":0}]})", "circle"},
      {R"("scenes":[{"nodes":[0]}],"nodes":[{"children":[0],"mesh":0}]})", "circle"},
      {R"("scenes":[{"nodes":[0]}],"nodes":[{"children":[1,1]},{"mesh":0}]})", "two parents"},
      {R"("scenes":[{"nodes":[0]}],"nodes":[{"children":[7]},{"mesh":0}]})", "nodes 7 of 2"},
      {R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":5}]})", "meshes 5 of 2"},
      {R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":-1}]})", ""},
      {R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":"no"}]})", "damaged"},
      {R"("scenes":[{"nodes":[0]}],"nodes":[{"name":"empty"}]})", "no "},
  };
  for (const auto& [tree, why] : nodes) {
    write_gltf(folder, tree);
    refused("a.gltf", why);
  }
  std::string deep = R"("scenes":[{"nodes":[0]}],"nodes":[)";
  for (int i = 1; i <= 20000; ++i) deep += R"({"children":[)" + std::to_string(i) + "]},";
  write_gltf(folder, deep + R"({"mesh":0}]})");
  refused("a.gltf", "deep");
  const std::tuple<const char*, const char*, const char*> tops[] = {
      {R"("byteLength":336)", R"("byteLength":337)", "truncated: buffer 0"},
      {R"("data.bin")", R"("gone.bin")", "gone.bin is missing"},
      {R"("count":36)", R"("count":37)", "accessor 0 reaches past"},
      {R"("count":8)", R"("count":18446744073709551615)", "accessor 1 reaches past"},
      {R"("count":8)", R"("count":1e300)", "whole number"},
      {R"("count":8)", R"("count":8,"sparse":{})", "key 'count' not found"},
      {R"("byteOffset":288)", R"("byteOffset":289)", "bufferView 3 reaches past"},
      {R"("POSITION":1)", R"("POSITION":9)", "accessors 9 of 4"},
      {R"("version":"2.0")", R"("version":"3.0")", "version 3.0"},
  };
  for (const auto& [from, to, why] : tops) {
    write_gltf(folder, kNodes, replaced(kTop, from, to));
    refused("a.gltf", why);
  }
  // Nesting that a recursive reader would follow to the end of its stack.
  const std::string lists = std::string(200'000, '[') + std::string(200'000, ']');
  write_gltf(folder, kNodes, replaced(kTop, R"("version":"2.0")", R"("version":"2.0","extras":)" + lists));
  refused("a.gltf", "its JSON is nested");
}

TEST_CASE("flat files are one part, or one for each connected piece", "[assembly]") {
  const TempFolder folder;
  const TriangleMesh box = shapes::box({0.02, 0.02, 0.02});
  std::string obj;
  std::uint32_t base = 1;
  for (int i = 0; i < 3; ++i) {
    obj += "o Klotz_" + std::to_string(i) + "\n";
    for (const Vec3& p : box.vertices) {
      const Vec3 q = 1000 * p + Vec3(100.0 * i + 5000, 0, 0);
      obj += "v " + std::to_string(q.x()) + " " + std::to_string(q.y()) + " " + std::to_string(q.z()) + "\n";
    }
    for (const auto& t : box.triangles)
      obj += "f " + std::to_string(t[0] + base) + " " + std::to_string(t[1] + base) + " " +
             std::to_string(t[2] + base) + "\n";
    base += 8;
  }
  folder.write("three.obj", obj);
  AssemblyOptions options;
  options.unit = "mm";
  const Assembly whole = read_assembly(folder / "three.obj", options);
  REQUIRE(whole.parts.size() == 1);
  CHECK(whole.parts[0].name == "three");
  CHECK(report(*whole.shapes[0]).components == 3);
  options.split = true;
  const Assembly split = read_assembly(folder / "three.obj", options);
  REQUIRE(split.parts.size() == 3);
  // Far from the origin, so they have got one of their own.
  for (std::size_t i = 0; i < 3; ++i) {
    const TriangleMesh& mesh = *split.shapes[split.parts[i].shape];
    CHECK(split.parts[i].name == "Klotz_" + std::to_string(i));
    CHECK(report(mesh).closed);
    CHECK(report(mesh).box_max.norm() == Approx(std::sqrt(3) * 0.01));
    CHECK((split.parts[i].pose.p - Vec3(5 + 0.1 * static_cast<double>(i), 0, 0)).norm() < 1e-6);
  }
}

TEST_CASE("the wall of a cavity stays with the part around it", "[assembly]") {
  const TempFolder folder;
  TriangleMesh hollow = shapes::box({0.04, 0.04, 0.04});
  const TriangleMesh cavity = shapes::box({0.02, 0.02, 0.02}), other = shapes::moved(cavity, {0.1, 0, 0});
  for (const auto* part : {&cavity, &other}) {
    const auto base = static_cast<std::uint32_t>(hollow.vertices.size());
    hollow.vertices.insert(hollow.vertices.end(), part->vertices.begin(), part->vertices.end());
    for (auto t : part->triangles) {
      if (part == &cavity) std::swap(t[1], t[2]);
      hollow.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    }
  }
  write_ply(hollow, folder / "hollow.ply", 1);
  AssemblyOptions options;
  options.split = true;
  const Assembly a = read_assembly(folder / "hollow.ply", options);
  REQUIRE(a.parts.size() == 2);
  CHECK(volume(*a.shapes[a.parts[0].shape]) == Approx(0.04 * 0.04 * 0.04 - 0.02 * 0.02 * 0.02));
  CHECK(volume(*a.shapes[a.parts[1].shape]) == Approx(0.02 * 0.02 * 0.02));
}

TEST_CASE("binary PLY reads back as the floats that were written", "[assembly]") {
  const TempFolder folder;
  const TriangleMesh knot = shapes::torus_knot({});
  write_ply(knot, folder / "knot.ply", 1e-3);
  const TriangleMesh back = load_mesh(folder / "knot.ply", 1e-3);
  REQUIRE(back.triangles.size() == knot.triangles.size());
  double worst = 0;
  for (std::size_t f = 0; f < knot.triangles.size(); ++f)
    for (int k = 0; k < 3; ++k)
      worst = std::max(worst, (back.vertices[back.triangles[f][k]] - knot.vertices[knot.triangles[f][k]]).norm());
  CHECK(worst < 0.1 * std::ldexp(1.0, -23));  // under 0.1 m
  CHECK_THROWS_WITH(write_ply(knot, folder / "none/knot.ply", 1), Catch::Contains("cannot be written"));
}

TEST_CASE("a file that is absurdly large in meters is refused until its unit is given", "[assembly]") {
  const TempFolder folder;
  const Vec3 size(743, 10, 10);
  write_ply(shapes::box(size), folder / "engine.ply", 1);
  const auto message = [](const std::string& path, const AssemblyOptions& options) -> std::string {
    try {
      read_assembly(path, options);
    } catch (const Error& e) {
      return e.what();
    }
    return "read";
  };
  const std::string asked = message(folder / "engine.ply", {});
  CHECK(asked.find("engine.ply: 743.1 m across") != std::string::npos);
  CHECK(asked.find("--unit mm") != std::string::npos);
  AssemblyOptions given;
  for (const auto& [unit, meter] : {std::pair("mm", 1e-3), std::pair("m", 1.0), std::pair("in", 0.0254)}) {
    given.unit = unit;
    const Assembly a = read_assembly(folder / "engine.ply", given);
    const MeshReport r = report(*a.shapes.at(0));
    CHECK((r.box_max - r.box_min - meter * size).norm() < 1e-6 * meter * size.norm());
    CHECK(a.unit == unit);
  }
  // A part of 21 mm whose file says nothing is one of 21 m, one of 19 m may be.
  write_ply(shapes::box({19, 1, 1}), folder / "wing.ply", 1);
  CHECK(message(folder / "wing.ply", {}) == "read");
}
