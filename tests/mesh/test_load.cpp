#include <fcntl.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "bodies.hpp"
#include "catch.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/import/load.hpp"
#include "tegotae/mesh/report.hpp"
#include "text.hpp"

using namespace tegotae;
using namespace tegotae::test;
namespace fs = std::filesystem;

namespace {

/// A folder of files that goes away with the test; also catches what is printed while it lives.
class Sandbox {
 public:
  Sandbox() {
    std::string name = (fs::temp_directory_path() / "tegotae-load-XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    folder_ = name;
  }
  ~Sandbox() { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return (folder_ / name).string();
  }

  /// What `action` printed on stdout and stderr.
  std::string printed(const std::function<void()>& action) const {
    const fs::path log = folder_ / "printed";
    std::fflush(nullptr);
    const int out = dup(1), err = dup(2), file = open(log.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
    dup2(file, 1);
    dup2(file, 2);
    action();
    std::fflush(nullptr);
    dup2(out, 1);
    dup2(err, 2);
    for (const int f : {out, err, file}) close(f);
    std::ifstream in(log, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }

 private:
  fs::path folder_;
};

/// Loads and returns the error's message; "" if it loaded. Nothing may be printed, nothing but Error thrown.
std::string refusal(const Sandbox& sandbox, const std::string& path) {
  std::string message;
  const std::string printed = sandbox.printed([&] {
    try {
      load_mesh(path);
    } catch (const Error& e) {
      message = e.what();
    }
  });
  CHECK(printed.empty());
  if (!message.empty()) {
    CHECK(message.rfind(path + ": ", 0) == 0);
    CHECK(message.find('\n') == std::string::npos);
  }
  return message;
}

template <class T>
void put(std::string& bytes, T value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

// The same tetrahedron (corners 0, x, y, z; edges 1) in every format.
const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
const std::string kOff = "OFF\n# four corners\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
const std::string kPly =
    "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

const int kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
const float kCorners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

std::string text_stl() {
  std::string s = "solid t\n";
  for (const auto& f : kFaces) {
    s += " facet normal 0 0 0\n  outer loop\n";
    for (const int i : f) {
      char line[80];
      std::snprintf(line, sizeof line, "   vertex %g %g %g\n", kCorners[i][0], kCorners[i][1], kCorners[i][2]);
      s += line;
    }
    s += "  endloop\n endfacet\n";
  }
  return s + "endsolid t\n";
}

std::string binary_stl() {
  std::string s(80, '\0');
  put(s, std::uint32_t{4});
  for (const auto& f : kFaces) {
    for (int k = 0; k < 3; ++k) put(s, 0.0f);
    for (const int i : f) {
      for (const float x : kCorners[i]) put(s, x);
    }
    put(s, std::uint16_t{0});
  }
  return s;
}

std::string binary_ply(bool big) {
  std::string s = kPly.substr(0, kPly.find("end_header\n") + 11);
  s = replaced(s, "ascii", big ? "binary_big_endian" : "binary_little_endian");
  const auto put_ordered = [&](auto value) {
    std::string raw;
    put(raw, value);
    s += big ? std::string(raw.rbegin(), raw.rend()) : raw;
  };
  for (const auto& c : kCorners) {
    for (const float x : c) put_ordered(x);
  }
  for (const auto& f : kFaces) {
    put(s, std::uint8_t{3});
    for (const std::int32_t i : f) put_ordered(i);
  }
  return s;
}

std::string corner_bytes() {
  std::string s;
  for (const auto& c : kCorners) {
    for (const float x : c) put(s, x);
  }
  for (const auto& f : kFaces) {
    for (const int i : f) put(s, static_cast<std::uint16_t>(i));
  }
  return s;
}

/// Two nodes of one mesh: moved by 5 along x under a parent scaled by 2, and mirrored in x at y = 10.
std::string gltf_json(const std::string& buffer) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,2]}],"nodes":[
    {"scale":[2,2,2],"children":[1]},{"mesh":0,"translation":[5,0,0]},
    {"mesh":0,"matrix":[-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,10,0,1]}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},
                 {"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}],
    "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24}],
    "buffers":[{)" +
         buffer + R"("byteLength":72}]})";
}

std::string glb() {
  std::string json = gltf_json("");
  while (json.size() % 4 != 0) json += ' ';
  const std::string body = corner_bytes();
  std::string s = "glTF";
  put(s, std::uint32_t{2});
  put(s, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + body.size()));
  put(s, static_cast<std::uint32_t>(json.size()));
  s += "JSON" + json;
  put(s, static_cast<std::uint32_t>(body.size()));
  s += std::string("BIN\0", 4) + body;
  return s;
}

}  // namespace

TEST_CASE("units", "[load]") {
  REQUIRE(unit_length("m") == 1.0);
  REQUIRE(unit_length("cm") == 0.01);
  REQUIRE(unit_length("mm") == 0.001);
  REQUIRE(unit_length("um") == 1e-6);
  REQUIRE(unit_length("in") == 0.0254);
  REQUIRE_THROWS_AS(unit_length("MM"), Error);
  REQUIRE_THROWS_AS(unit_length(""), Error);
}

TEST_CASE("a tetrahedron loads the same from every format", "[load]") {
  const Sandbox s;
  for (const std::string& path :
       {s.write("t.obj", kObj), s.write("t.off", kOff), s.write("t.ply", kPly),
        s.write("little.PLY", binary_ply(false)), s.write("big.ply", binary_ply(true)), s.write("text.stl", text_stl()),
        s.write("binary.STL", binary_stl()), s.write("negative.obj", replaced(kObj, "f 2 3 4", "f -3 -2 -1"))}) {
    INFO(path);
    TriangleMesh mesh;
    REQUIRE(s.printed([&] { mesh = load_mesh(path, 0.0254); }).empty());
    REQUIRE(mesh.name == path);
    REQUIRE(mesh.vertices.size() == 4);
    REQUIRE(mesh.triangles.size() == 4);
    REQUIRE(report(mesh).closed);
    REQUIRE(volume(mesh) == Approx(0.0254 * 0.0254 * 0.0254 / 6).epsilon(1e-12));
  }
}

TEST_CASE("what OBJ, OFF and PLY files have beside places and corners changes nothing", "[load]") {
  const Sandbox s;
  const std::string corners = kObj.substr(0, kObj.find('f'));
  const std::string faces = "3 0 2 1 200 100 0\n3 0 1 3 0.5 0.5 0.5\n3 1 2 3\n3 2 0 3 7\n";
  std::vector<std::string> files = {
      s.write("all.obj", "# made by hand\no part\n" + corners +
                             "vt 0 0\nvt 1 0\nvn 0 0 1\ng front back\ns 1\nf 1/1/1 3/2/1 \\\n 2/1/1\nf 1//1 2//1 4//1\n"
                             "g other\nf 2/1 3/1 4/1\nf 3 1 4\n"),
      s.write("curves.obj", kObj + "vp 0.5\ncstype bezier\ndeg 1\ncurv 0 1 1 2\nparm u 0 1\nend\n"),
      s.write("colors.off", "COFF\n4 4 6\n0 0 0 255 0 0 255\n1 0 0 0 255 0 9\n0 1 0 1 2 3 4\n0 0 1 5 6 7 8\n" + faces),
      s.write("normals.off", "NOFF\n4 4 6\n0 0 0 0 0 -1\n1 0 0 1 0 0\n0 1 0 0 1 0\n0 0 1 0 0 1\n" + faces)};
  for (const char* type : {"char", "int8", "uchar", "uint8", "short", "int16", "ushort", "uint16", "int", "int32",
                           "uint", "uint32", "float", "float32", "double", "float64"})
    files.push_back(s.write(std::string(type) + ".ply", replaced(replaced(kPly, "float x", type + std::string(" x")),
                                                                 "float z", type + std::string(" z"))));
  for (const std::string& path : files) {
    INFO(path);
    const TriangleMesh mesh = load_mesh(path);
    CHECK(mesh.vertices.size() == 4);
    CHECK(mesh.triangles.size() == 4);
    CHECK(report(mesh).closed);
    CHECK(volume(mesh) == Approx(1.0 / 6).epsilon(1e-12));
  }
}

TEST_CASE("glTF nodes are placed, mirrored ones keep their outside", "[load]") {
  const Sandbox s;
  s.write("t.bin", corner_bytes());
  // The bytes of t.bin.
  const std::string data =
      "data:application/octet-stream;base64,"
      "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"
      "AAAAAAAAAAAAAIA/AAACAAEAAAABAAMAAQACAAMAAgAAAAMA";
  for (const std::string& path :
       {s.write("t.gltf", gltf_json(R"("uri":"t.bin",)")), s.write("data.gltf", gltf_json("\"uri\":\"" + data + "\",")),
        s.write("t.glb", glb())}) {
    INFO(path);
    const TriangleMesh mesh = load_mesh(path);
    const MeshReport r = report(mesh);
    REQUIRE(r.components == 2);
    REQUIRE(r.closed);
    REQUIRE((r.box_min - Vec3(-1, 0, 0)).norm() < 1e-6);
    REQUIRE((r.box_max - Vec3(12, 11, 2)).norm() < 1e-6);
    REQUIRE(volume(mesh) == Approx(8.0 / 6 + 1.0 / 6).epsilon(1e-6));
  }
}

TEST_CASE("polygons are triangulated, points and lines dropped", "[load]") {
  const Sandbox s;
  const TriangleMesh mesh = load_mesh(s.write("q.obj",
                                              "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\n"
                                              "p 1\nl 1 2 3\nf 1// 2//\nf 1 2 3 4 5\n"));
  REQUIRE(mesh.triangles.size() == 3);
  double area = 0;  // the polygon is not convex: a fan would give more
  for (const auto& t : mesh.triangles) {
    const Vec3 n = (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    REQUIRE(n.z() > 0);
    area += 0.5 * n.norm();
  }
  REQUIRE(area == Approx(4 - 1.5).epsilon(1e-6));
}

TEST_CASE("files that cannot be used are refused with the reason", "[load]") {
  const Sandbox s;
  const auto refuse = [&](const std::string& name, const std::string& bytes, const std::string& reason) {
    INFO(name);
    const std::string message = refusal(s, s.write(name, bytes));
    INFO(message);
    CHECK(message.find(reason) != std::string::npos);
  };
  CHECK(refusal(s, "/no/such/file.stl").find("no such file") != std::string::npos);
  CHECK(refusal(s, fs::temp_directory_path().string()).find("not a regular file") != std::string::npos);
  CHECK(refusal(s, "/dev/zero").find("not a regular file") != std::string::npos);
  for (const char* name : {"e.stl", "e.obj", "e.ply", "e.off", "e.gltf", "e.glb"}) {
    refuse(name, "", "empty file");
    refuse(name, " \n\n", "empty file");
  }
  refuse("part.step", "ISO-10303-21;\nHEADER;\n", "STEP");
  refuse("part.stl", "ISO-10303-21;\nHEADER;\n", "STEP");
  refuse("part.txt", kObj, "unknown format");
  refuse("part", kObj, "unknown format");
  refuse("scene.toml", "[[part]]\n", "a scene file, where a part is wanted");
  refuse("none.stl", std::string(84, '\0'), ": no triangles");

  refuse("empty.stl", "solid Empty\nendsolid Empty", "no triangles");
  refuse("points.obj", "v 0 0 0\nv 1 0 0\np 1\nl 1 2\n", "no triangles");
  refuse("vertices.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "no triangles");
  refuse("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "no triangle has an area");

  refuse("range.obj", replaced(kObj, "f 2 3 4", "f 2 3 9"), "index");
  refuse("zero.obj", replaced(kObj, "f 2 3 4", "f 2 3 0"), "index");
  refuse("negative.obj", replaced(kObj, "f 2 3 4", "f 2 3 -9"), "index");
  refuse("range.off", replaced(kOff, "3 1 2 3", "3 1 2 4"), "out of range");
  refuse("negative.off", replaced(kOff, "3 1 2 3", "3 1 2 -1"), "out of range");
  refuse("range.ply", replaced(kPly, "3 1 2 3", "3 1 2 4"), "out of range");
  refuse("negative.ply", replaced(kPly, "3 1 2 3", "3 1 2 -1"), "out of range");

  for (const char* bad : {"nan", "inf", "-inf", "1e30", "1e300", "1000001"}) {
    const std::string x = std::string(bad) + " 0 0\n";
    refuse("bad.obj", replaced(kObj, "1 0 0\n", x), "coordinate");
    refuse("bad.stl", replaced(text_stl(), "1 0 0\n", x), "coordinate");
  }
  std::string nan_stl = binary_stl();
  const std::uint32_t nan = 0x7fc00000;
  std::memcpy(&nan_stl[84 + 12], &nan, 4);
  refuse("nan.stl", nan_stl, "coordinate");

  refuse("header.ply", "ply\nformat ascii 1.0\nelement vertex 4\n", "header");
  refuse("none.ply", "plx\n" + kPly, "ply");
  refuse("many.ply", replaced(kPly, "face 4", "face 4000000000"), "truncated");
  refuse("words.ply", replaced(kPly, "3 1 2 3", "3 1 2 3 1"), "more values on its line");
  refuse("lines.ply", replaced(kPly, "3 1 2 3", "3 1 2\n3"), "truncated or damaged at face");
  refuse("length.ply", replaced(kPly, "3 1 2 3", "3.5 1 2 3"), "damaged at face");
  refuse("wide.ply", replaced(kPly, "3 1 2 3", "259 1 2 3"), "damaged at face");
  std::string round, corners = "f";
  for (int i = 0; i < 40000; ++i) {
    round += "v " + std::to_string(std::cos(i * 1e-4)) + ' ' + std::to_string(std::sin(i * 1e-4)) + " 0\n";
    corners += ' ' + std::to_string(i + 1);
  }
  refuse("round.obj", round + corners + '\n', "40000 corners would take too long");
  refuse("lines.off", replaced(kOff, "3 1 2 3", "3 1\n2 3"), "takes a line");
  refuse("two.off", replaced(kOff, "1 0 0\n", "1 0 0 "), "damaged at face 3");
  refuse("binary.off", std::string("OFF BINARY\n\0\0\0\4", 15), "text OFF only");
  refuse("feed.off", replaced(kOff, "1 0 0\n", "1 0 0 \f\n"), "control characters");
  refuse("many.off", replaced(kOff, "4 4 6", "400000000 400000000 0"), "truncated");
  std::string many = binary_stl();
  std::memset(&many[80], 0xff, 4);
  refuse("many.stl", many, "truncated");
  refuse("long.stl", binary_stl() + std::string(25, '\0') + std::string(25, '\1'), "damaged");
}

TEST_CASE("a file cut anywhere is refused, or it was whole but for its last line break", "[load]") {
  const Sandbox s;
  const auto cut_everywhere = [&](const std::string& name, const std::string& bytes, std::size_t whole) {
    for (std::size_t n = 0; n < whole; ++n) {
      const std::string message = refusal(s, s.write(name, bytes.substr(0, n)));
      INFO(name << " cut at " << n << " of " << bytes.size() << ": " << message);
      CHECK(!message.empty());
    }
  };
  cut_everywhere("cut.stl", binary_stl(), binary_stl().size());
  cut_everywhere("text.stl", text_stl(), text_stl().find("endsolid") + 8);
  cut_everywhere("cut.ply", kPly, kPly.size() - 1);
  cut_everywhere("little.ply", binary_ply(false), binary_ply(false).size());
  cut_everywhere("big.ply", binary_ply(true), binary_ply(true).size());
  cut_everywhere("cut.off", kOff, kOff.size() - 1);
  cut_everywhere("cut.glb", glb(), glb().size());
  s.write("t.bin", corner_bytes());
  const std::string json = gltf_json(R"("uri":"t.bin",)");
  cut_everywhere("cut.gltf", json, json.size());
  // An OBJ file has no end mark: what is missing shows only inside a line.
  for (const std::string& last : {std::string("f 3 1"), std::string("f 3"), std::string("v 1 2")}) {
    CHECK(refusal(s, s.write("cut.obj", kObj + last)).find("truncated") != std::string::npos);
  }
  s.write("t.bin", corner_bytes().substr(0, 60));
  CHECK(!refusal(s, s.write("short.gltf", json)).empty());
  fs::remove(s.write("t.bin", ""));
  CHECK(!refusal(s, s.write("missing.gltf", json)).empty());
}
