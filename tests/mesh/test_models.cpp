#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "catch.hpp"
#include "tegotae/import/load.hpp"
#include "tegotae/mesh/report.hpp"

using namespace tegotae;
namespace fs = std::filesystem;

namespace {

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

int run(const std::string& arguments) {
  const std::string command = std::string(TEGOTAE_BIN_DIR) + "/tegotae-models " + arguments;
  return WEXITSTATUS(std::system(command.c_str()));
}

struct TemporaryFolder {
  fs::path path;
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "tegotae-models-XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path = name;
  }
  ~TemporaryFolder() { fs::remove_all(path); }
};

}  // namespace

TEST_CASE("the committed models are what the generator writes", "[models]") {
  const TemporaryFolder folder;
  REQUIRE(run("--out " + folder.path.string()) == 0);
  int files = 0;
  for (const auto& entry : fs::directory_iterator(TEGOTAE_MODELS_DIR)) {
    if (entry.path().extension() != ".obj") continue;
    ++files;
    INFO(entry.path().filename().string());
    const std::string made = bytes_of(folder.path / entry.path().filename());
    REQUIRE(!made.empty());
    REQUIRE((made == bytes_of(entry.path())));
    REQUIRE(report(load_mesh(entry.path().string(), unit_length("mm"))).closed);
  }
  REQUIRE(files == 9);
  for (const auto& entry : fs::directory_iterator(folder.path)) {
    REQUIRE(fs::exists(fs::path(TEGOTAE_MODELS_DIR) / entry.path().filename()));
  }
}

TEST_CASE("finer ratios on request", "[models]") {
  const TemporaryFolder folder;
  REQUIRE(run("--ratio 0.999 --segments 256 --rings 20 --out " + folder.path.string()) == 0);
  const MeshReport peg = report(load_mesh((folder.path / "peg_0.999.obj").string(), 1e-3));
  REQUIRE(peg.closed);
  REQUIRE(peg.box_max.x() == Approx(0.00999).epsilon(1e-6));
  REQUIRE(peg.triangles >= 2 * 256 * 20);
  REQUIRE(report(load_mesh((folder.path / "hole_20.obj").string(), 1e-3)).closed);
  REQUIRE(!fs::exists(folder.path / "cube.obj"));
}

TEST_CASE("the generator refuses bad usage with exit code 2 and one line", "[models]") {
  const TemporaryFolder folder;
  const std::string out = "--out " + folder.path.string(), log = (folder.path / "log").string();
  for (const std::string& bad : {std::string(), out + " --ratio 1.2", out + " --ratio x", out + " --segments 60",
                                 out + " --segments -8", out + " --wrong", std::string("--out /dev/null/models")}) {
    INFO(bad);
    REQUIRE(run(bad + " 2> " + log) == 2);
    const std::string message = bytes_of(log);
    REQUIRE(message.rfind("tegotae-models: ", 0) == 0);
    REQUIRE(message.find('\n') == message.size() - 1);
  }
}
