// Mesh files of a scene: each is read once, in several threads, and errors do not depend on which thread was faster.
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "catch.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/scene_file/scene_file.hpp"

using namespace tegotae;
namespace fs = std::filesystem;

namespace {

constexpr int kFiles = 12, kCopies = 60;

// Part i has file i mod kFiles. Its mesh is never read: the loader makes one up that tells the file's number.
class ManyFiles {
 public:
  ManyFiles() : folder_(fs::temp_directory_path() / ("tegotae_mesh_files_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
    std::ofstream scene(path());
    for (int i = 0; i < kFiles; ++i) std::ofstream(folder_ / name(i));
    for (int i = 0; i < kCopies; ++i)
      scene << "[[part]]\nname = \"p" << i << "\"\nmesh = \"" << name(i % kFiles) << "\"\n"
            << (i == 0 ? "held = true\n" : "");
  }
  ~ManyFiles() { fs::remove_all(folder_); }
  static std::string name(int file) { return std::to_string(file) + ".obj"; }
  std::string path() const { return (folder_ / "scene.toml").string(); }

 private:
  fs::path folder_;
};

int number_of(const std::string& file) {
  return std::stoi(fs::path(file).stem().string());
}

TriangleMesh triangle(double size) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {size, 0, 0}, {0, size, 0}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

}  // namespace

TEST_CASE("every mesh file of a scene is read once and shared by its parts", "[scene_file]") {
  const ManyFiles files;
  std::mutex mutex;
  std::map<int, int> reads;
  std::vector<std::size_t> told, totals;
  SceneOptions options;
  options.load = [&](const std::string& file, double) {
    const std::lock_guard<std::mutex> lock(mutex);
    ++reads[number_of(file)];
    return triangle(1 + number_of(file));
  };
  options.progress = [&](std::size_t done, std::size_t total) {
    told.push_back(done);
    totals.push_back(total);
  };
  const SceneFile file = load_scene(files.path(), options);
  REQUIRE(file.scene.parts.size() == kCopies);
  for (int i = 0; i < kCopies; ++i) {
    const Part& part = file.scene.parts[static_cast<std::size_t>(i)];
    CHECK(part.mesh == file.scene.parts[static_cast<std::size_t>(i % kFiles)].mesh);
    CHECK(part.mesh->vertices[1].x() == 1 + i % kFiles);
  }
  CHECK(reads.size() == kFiles);
  for (const auto& [number, times] : reads) CHECK(times == 1);
  REQUIRE(told.size() == kFiles + 1);
  for (std::size_t i = 0; i < told.size(); ++i) CHECK(told[i] == i);
  for (const std::size_t total : totals) CHECK(total == kFiles);
}

TEST_CASE("of several mesh files that cannot be read the first one in the scene is named", "[scene_file]") {
  const ManyFiles files;
  for (int first = 0; first < kFiles - 1; ++first) {
    SceneOptions options;
    // The first one fails last.
    options.load = [&](const std::string& file, double) -> TriangleMesh {
      if (number_of(file) < first) return triangle(1);
      if (number_of(file) == first) std::this_thread::sleep_for(std::chrono::milliseconds(5));
      throw Error("number " + std::to_string(number_of(file)) + " is bad");
    };
    std::string text;
    try {
      load_scene(files.path(), options);
    } catch (const Error& e) {
      text = e.what();
    }
    CAPTURE(first, text);
    // Three lines a part, of which the third names the mesh, and one more for the held part, the first.
    CHECK(text.find("scene.toml:" + std::to_string(3 * first + (first > 0 ? 4 : 3)) + ": ") != std::string::npos);
    CHECK(text.find("number " + std::to_string(first) + " is bad") != std::string::npos);
  }
}
