// load_mesh_isolated against load_mesh, and against helpers that misbehave (scripts in place of the real one).
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "core/sanitizers.hpp"
#include "mesh/assembly_checks.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/import/isolated_load.hpp"
#include "tegotae/import/load.hpp"

using namespace tegotae;
namespace fs = std::filesystem;

namespace {

const std::string kHelper = std::string(TEGOTAE_BIN_DIR) + "/tegotae-load-mesh";

class Sandbox {
 public:
  Sandbox() {
    std::string name = (fs::temp_directory_path() / "tegotae-isolated-XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    folder_ = name;
  }
  ~Sandbox() { fs::remove_all(folder_); }
  std::string write(const std::string& name, const std::string& bytes, bool program = false) const {
    const fs::path path = folder_ / name;
    std::ofstream(path, std::ios::binary) << bytes;
    if (program) fs::permissions(path, fs::perms::owner_all);
    return path.string();
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

 private:
  fs::path folder_;
};

const std::string kTetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

std::string refusal(const std::string& path, const IsolatedLoad& bounds) {
  const std::string what = test::refusal([&] { load_mesh_isolated(path, 1.0, bounds); });
  if (!what.empty()) CHECK(what.rfind(path + ": ", 0) == 0);
  CHECK(what.find('\n') == std::string::npos);
  return what;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

int open_descriptors() {
  int n = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator("/proc/self/fd")) ++n;
  return n;
}

}  // namespace

TEST_CASE("a mesh comes back bit for bit", "[isolated]") {
  for (const char* name : {"peg_0.94.obj", "hole_20.obj"}) {
    const std::string file = std::string(TEGOTAE_MODELS_DIR) + "/" + name;
    const int before = open_descriptors();
    const TriangleMesh here = load_mesh(file, 1e-3), there = load_mesh_isolated(file, 1e-3, {kHelper});
    CHECK(there.name == here.name);
    CHECK(there.vertices == here.vertices);
    CHECK(there.triangles == here.triangles);
    CHECK(open_descriptors() == before);
  }
}

TEST_CASE("what is told of a file comes along, on one line each", "[isolated]") {
  const Sandbox s;
  s.write("c.bin", std::string("\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0", 36));
  const std::string file =
      s.write("a.gltf", R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"animations":[{"channels":[],"samplers":[]}],
"extensionsUsed":["ACME\n\u001b[1mbold"],"buffers":[{"byteLength":36,"uri":"c.bin"}],
"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]})");
  const TriangleMesh here = load_mesh(file), there = load_mesh_isolated(file, 1.0, {kHelper});
  CHECK(here.triangles.size() == 1);
  REQUIRE(here.notes.size() == 2);
  CHECK(there.notes == here.notes);
  CHECK(contains(here.notes[0] + here.notes[1], "animations"));
  CHECK(contains(here.notes[0] + here.notes[1], "ACME  [1mbold is not read"));
}

TEST_CASE("an error is the error of load_mesh", "[isolated]") {
  const Sandbox s;
  for (const std::string& file : {s.write("e.stl", ""), s.write("r.obj", "v 0 0 0\nf 1 2 3\n"), s.path("missing.ply"),
                                  s.write("odd name\n.txt", "x")}) {
    const std::string here = test::refusal([&] { load_mesh(file); });
    const std::string there = test::refusal([&] { load_mesh_isolated(file, 1.0, {kHelper}); });
    CHECK(!here.empty());
    CHECK(there == here);
  }
}

TEST_CASE("a helper that dies, hangs or lies is an error", "[isolated]") {
  const Sandbox s;
  const std::string file = s.write("t.obj", kTetrahedron);
  const auto program = [&](const std::string& name, const std::string& body) {
    return s.write(name, "#!/bin/sh\n" + body + "\n", true);
  };
  CHECK(contains(refusal(file, {s.path("none")}), "cannot be started"));
  CHECK(contains(refusal(file, {program("segv", "kill -SEGV $$")}), "died: Segmentation fault"));
  CHECK(contains(refusal(file, {program("abort", "kill -ABRT $$")}), "died: Aborted"));
  CHECK(contains(refusal(file, {program("exit", "exit 3")}), "ended with code 3"));
  CHECK(contains(refusal(file, {program("noise", "head -c 1000 /dev/urandom >&3")}), "another version"));
  CHECK(contains(refusal(file, {program("partial", "printf 1TEGMSH1 >&3")}), "ended with code 0"));

  // Were it waited for, the test would take too long for its own bound.
  CHECK(contains(refusal(file, {program("sleep", "exec sleep 1000000"), 0.3}), "not loaded within 0.3 s"));

  CHECK(contains(refusal(file, {kHelper, -1}), "time"));
  CHECK(contains(refusal(file, {kHelper, 1, 0}), "memory"));
}

TEST_CASE("what the helper sends is checked", "[isolated]") {
  const Sandbox s;
  const std::string file = s.write("t.obj", kTetrahedron);
  // A head and a body as the real helper writes them, with one number wrong.
  const auto sent = [&](std::uint64_t text, std::uint64_t notes, std::uint64_t vertices, std::uint32_t index) {
    std::string bytes;
    const auto put = [&](auto v) { bytes.append(reinterpret_cast<const char*>(&v), sizeof v); };
    bytes += "1TEGMSH2";
    put(std::uint64_t{0}), put(text), put(notes), put(vertices), put(std::uint64_t{1});
    if (notes == 6) bytes += "a\x1b\nbc\n";
    for (double x : {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0}) put(x);
    put(std::uint32_t{0}), put(std::uint32_t{1}), put(index);
    s.write("bytes", bytes);
    return s.write("send", "#!/bin/sh\ncat " + s.path("bytes") + " >&3\n", true);
  };
  CHECK(load_mesh_isolated(file, 1.0, {sent(0, 0, 3, 2)}).triangles.size() == 1);
  CHECK(load_mesh_isolated(file, 1.0, {sent(0, 6, 3, 2)}).notes == std::vector<std::string>{"a ", "bc"});
  CHECK(contains(refusal(file, {sent(0, std::uint64_t{1} << 60, 3, 2)}), "more than its memory"));
  CHECK(contains(refusal(file, {sent(0, 0, 3, 3)}), "no usable mesh"));
  CHECK(contains(refusal(file, {sent(1u << 30, 0, 3, 2)}), "sent no mesh"));
  CHECK(contains(refusal(file, {sent(0, 0, std::uint64_t{1} << 60, 2)}), "more than its memory"));
}

TEST_CASE("memory and time of the helper are bounded", "[isolated]") {
  const Sandbox s;
  std::string big;
  for (int i = 0; i < 60'000; ++i) big += kTetrahedron;
  const std::string file = s.write("big.obj", big);
#if !defined(TEGOTAE_SANITIZED)
  const std::string memory = refusal(file, {kHelper, 100, 60});
  INFO(memory);
  CHECK((contains(memory, "not enough memory") || contains(memory, "bad_alloc") || contains(memory, "process")));
#endif
  CHECK(contains(refusal(file, {kHelper, 0.01}), "not loaded within"));
}

TEST_CASE("loads run beside each other and beside other threads", "[isolated]") {
  const std::string file = std::string(TEGOTAE_MODELS_DIR) + "/peg_0.94.obj";
  const TriangleMesh here = load_mesh(file);
  std::array<bool, 4> same{};
  std::vector<std::thread> threads;
  for (bool& ok : same)
    threads.emplace_back([&] {
      for (int i = 0; i < 3; ++i) ok = load_mesh_isolated(file, 1.0, {kHelper}).triangles == here.triangles;
    });
  for (std::thread& t : threads) t.join();
  for (const bool ok : same) CHECK(ok);
}

TEST_CASE("a mesh file that names a pipe or a file elsewhere is not followed", "[load]") {
  const Sandbox s;
  fs::create_directory(s.path("inner"));
  REQUIRE(mkfifo(s.path("pipe.mtl").c_str(), 0600) == 0);
  REQUIRE(mkfifo(s.path("pipe.bin").c_str(), 0600) == 0);
  CHECK(load_mesh(s.write("t.obj", "mtllib pipe.mtl\n" + kTetrahedron)).triangles.size() == 4);
  const auto gltf = [](const std::string& uri) {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
           R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
           R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
           R"("bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"uri":")" +
           uri + R"(","byteLength":36}]})";
  };
  std::string corners;
  for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f})
    corners.append(reinterpret_cast<const char*>(&x), sizeof x);
  s.write("corners.bin", corners);
  CHECK(load_mesh(s.write("good.gltf", gltf("corners.bin"))).triangles.size() == 1);
  CHECK_THROWS_AS(load_mesh(s.write("pipe.gltf", gltf("pipe.bin"))), Error);
  CHECK_THROWS_AS(load_mesh(s.write("inner/up.gltf", gltf("../corners.bin"))), Error);
}
