// What was read of a mesh file and kept, against reading it; and triangles read without assimp, against assimp.
#include <assimp/Importer.hpp>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <random>

#include "absent.hpp"
#include "apps/run_program.hpp"
#include "cache_folder.hpp"
#include "catch.hpp"
#include "import/load_assimp.hpp"
#include "import/load_triangles.hpp"
#include "mesh/cache_entry.hpp"
#include "mesh/surface.hpp"
#include "models/shapes.hpp"
#include "models/write_obj.hpp"
#include "models/write_stl.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/import/isolated_load.hpp"
#include "tegotae/import/load.hpp"
#include "tegotae/import/write.hpp"
#include "tegotae/narrowphase/hierarchy_cache.hpp"

using namespace tegotae;
using namespace tegotae::test;
namespace fs = std::filesystem;

namespace {

template <typename T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

bool same(const TriangleMesh& a, const TriangleMesh& b) {
  return a.name == b.name && a.notes == b.notes && same_bytes(a.vertices, b.vertices) &&
         same_bytes(a.triangles, b.triangles);
}

/// A mesh, or why there is none.
struct Answer {
  TriangleMesh mesh;
  std::string error;
};

Answer read(const std::string& path) {
  Answer answer;
  try {
    answer.mesh = load_mesh(path, 1e-3);
  } catch (const Error& e) {
    answer.error = e.what();
  }
  return answer;
}

/// All files that may be meshes, of the parts and of the models.
std::vector<std::string> all_files() {
  std::vector<std::string> files;
  for (const char* folder : {TEGOTAE_PARTS_DIR, TEGOTAE_MODELS_DIR}) {
    if (!fs::exists(folder)) {
      note_absent(std::string("no folder ") + folder);
      continue;
    }
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.is_regular_file()) files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// The same surface in four formats; `mesh` has to be in m.
std::vector<std::string> written(const TempFolder& folder, const TriangleMesh& mesh) {
  write_ply(mesh, folder / "a.ply", 1e-3);
  write_obj(mesh, folder / "a.obj");
  write_stl(mesh, folder / "a.stl");
  return {folder / "a.ply", folder / "a.obj", folder / "a.stl"};
}

const TriangleMesh& big() {
  static const TriangleMesh mesh = shapes::sphere(0.05, 200, 60);
  REQUIRE(mesh.triangles.size() >= kMinCached);
  return mesh;
}

}  // namespace

TEST_CASE("every file is the same with the cache, the first time and after", "[load_cached]") {
  const TempFolder folder;
  std::vector<std::string> files = all_files();
  for (const std::string& file : written(folder, big())) files.push_back(file);
  std::size_t kept = 0;
  for (const std::string& file : files) {
    INFO(file);
    const Answer plain = read(file);
    const UseCache use(folder / "cache");
    const std::size_t before = entries(folder / "cache").size();
    for (int i = 0; i < 2; ++i) {
      const Answer cached = read(file);
      CHECK(same(cached.mesh, plain.mesh));
      CHECK(cached.error == plain.error);
    }
    const std::size_t after = entries(folder / "cache").size();
    CHECK(after == before + (plain.mesh.triangles.size() >= kMinCached ? 1 : 0));
    kept = after;
  }
  CHECK(kept >= 3);
}

TEST_CASE("triangles read without assimp are assimp's", "[load_cached]") {
  const TempFolder folder;
  std::vector<std::string> files = all_files();
  for (const std::string& file : written(folder, big())) files.push_back(file);
  folder.write("few.obj",
               "mtllib a.mtl\no a\nusemtl b\nv 0.1 -.25 1e-3\nv 1.23456789012345678 0 0\nv 0 +1 0\n"
               "f 1 2 3\nf -1 -2 -3\n");
  folder.write("turn.obj", "v 0 0 0\no a\nv 1 0 0\nv 0 1 0\nf 1 2 3\no b\nf 3 2 1\no a\nf 1 3 2\n");
  for (const char* name : {"few.obj", "turn.obj"}) files.push_back(folder / name);
  int compared = 0, left = 0;
  for (const std::string& file : files) {
    INFO(file);
    std::optional<PlainMesh> plain;
    try {
      if (!is_part_file(file)) plain = plain_mesh(file);
    } catch (const Error&) {
      continue;  // refused before either
    }
    if (!plain) continue;
    const auto triangles = triangles_of(*plain);
    if (!triangles) {
      ++left;
      continue;
    }
    TriangleMesh by_assimp;
    Assimp::Importer importer;
    try {
      const aiScene& scene = read_scene(importer, file, *plain, false);
      REQUIRE(scene.mNumMeshes == 1);
      by_assimp = triangles_of(*scene.mMeshes[0]);
    } catch (const Error& e) {
      FAIL(e.what());
    }
    CHECK(same_bytes(triangles->vertices, by_assimp.vertices));
    CHECK(same_bytes(triangles->triangles, by_assimp.triangles));
    ++compared;
  }
  CHECK(compared >= 4);
  CHECK(left >= 1);  // turn.obj
}

TEST_CASE("a damaged entry is read anew and replaced", "[load_cached]") {
  const TempFolder folder;
  const std::string file = written(folder, big())[2];
  const TriangleMesh plain = load_mesh(file, 1e-3);
  const auto surface_of = [](const TriangleMesh& mesh) { return Surface(std::make_shared<TriangleMesh>(mesh)); };
  const Surface built = surface_of(plain);
  const auto sound = [&] {
    const auto mesh = std::make_shared<const TriangleMesh>(load_mesh(file, 1e-3));
    const auto s = cached_surface(mesh);
    return same(*mesh, plain) && same_bytes(s->topology.twin, built.topology.twin) &&
           same_bytes(s->topology.face_normals, built.topology.face_normals) &&
           same_bytes(s->topology.vertex_edges, built.topology.vertex_edges) &&
           same_bytes(s->regions.of_face, built.regions.of_face) &&
           same_bytes(s->regions.corners, built.regions.corners);
  };
  const UseCache use(folder / "cache");
  REQUIRE(sound());
  REQUIRE(entries(folder / "cache").size() == 2);  // mesh, surface
  REQUIRE(sound());
  std::mt19937 random(9);
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  for (const fs::path& entry : entries(folder / "cache")) {
    const std::string bytes = read_text(entry);
    for (int i = 0; i < 60; ++i) {
      std::string bad = bytes;
      const std::size_t at = i < 20 ? below(100) : below(bad.size());  // the heads of entry and block more often
      switch (i % 4) {
        case 0:
          bad.resize(at);
          break;
        case 1:
          bad.insert(at, bad, at, 1 + below(64));
          break;
        case 2:
          bad += std::string(1 + below(9), '\0');
          break;
        default:
          bad[at] = static_cast<char>(bad[at] ^ (1 << below(8)));
      }
      INFO(entry << ", damage " << i << " at " << at);
      std::ofstream(entry, std::ios::binary) << bad;
      CHECK(sound());
      // But for padding inside its records, it is written as before.
      CHECK(read_text(entry).size() == bytes.size());
    }
  }
}

TEST_CASE("an entry belongs to a content, an extension and a unit", "[load_cached]") {
  const TempFolder folder;
  const std::vector<std::string> files = written(folder, big());
  const UseCache use(folder / "cache");
  const auto count = [&] { return entries(folder / "cache").size(); };
  load_mesh(files[0], 1e-3);
  REQUIRE(count() == 1);
  fs::copy_file(files[0], folder / "b.PLY");
  CHECK(load_mesh(folder / "b.PLY", 1e-3).name == folder / "b.PLY");
  CHECK(count() == 1);
  const TriangleMesh larger = load_mesh(files[0], 1e-2);
  CHECK(count() == 2);
  CHECK(larger.vertices[5].norm() == Approx(10 * load_mesh(files[0], 1e-3).vertices[5].norm()));
  std::string other = read_text(files[0]);
  other[other.size() / 4] = static_cast<char>(other[other.size() / 4] ^ 1);
  folder.write("c.ply", other);
  load_mesh(folder / "c.ply", 1e-3);
  CHECK(count() == 3);
}

TEST_CASE("what is kept needs no loading process", "[load_cached]") {
  const TempFolder folder;
  const std::string file = written(folder, big())[0];
  const TriangleMesh plain = load_mesh(file, 1e-3);
  const UseCache use(folder / "cache");
  IsolatedLoad nobody;
  nobody.helper = folder / "nobody";
  CHECK_THROWS_AS(load_mesh_isolated(file, 1e-3, nobody), Error);
  CHECK(entries(folder / "cache").empty());
  load_mesh(file, 1e-3);
  CHECK(same(load_mesh_isolated(file, 1e-3, nobody), plain));
}

TEST_CASE("files that name others, and folders that cannot be written", "[load_cached]") {
  const TempFolder folder;
  const UseCache use(folder / "cache");
  // A sphere with its corners in another file.
  std::string buffer;
  for (const Vec3& p : big().vertices)
    for (const double x : p) {
      const auto f = static_cast<float>(x);
      buffer.append(reinterpret_cast<const char*>(&f), sizeof f);
    }
  const std::size_t corners = buffer.size();
  buffer.append(reinterpret_cast<const char*>(big().triangles.data()), 12 * big().triangles.size());
  folder.write("a.bin", buffer);
  const auto n = [](std::size_t x) { return std::to_string(x); };
  // As a string may be written, too.
  for (const char* key : {"uri", "\\u0075ri", "ur\\u0069"}) {
    CAPTURE(key);
    folder.write(
        "a.gltf",
        R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},)"
        R"("indices":1}]}],"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":)" +
            n(big().vertices.size()) + R"(},{"bufferView":1,"componentType":5125,"type":"SCALAR","count":)" +
            n(3 * big().triangles.size()) + R"(}],"bufferViews":[{"buffer":0,"byteLength":)" + n(corners) +
            R"(},{"buffer":0,"byteOffset":)" + n(corners) + R"(,"byteLength":)" + n(buffer.size() - corners) +
            R"(}],"buffers":[{")" + key + R"(":"a.bin","byteLength":)" + n(buffer.size()) + "}]}");
    CHECK(load_mesh(folder / "a.gltf").triangles.size() == big().triangles.size());
    CHECK(entries(folder / "cache").empty());
  }
  const std::string file = written(folder, big())[0];
  folder.write("plain", "");
  set_hierarchy_cache(folder / "plain/cache");
  CHECK(load_mesh(file).triangles.size() == big().triangles.size());
}
