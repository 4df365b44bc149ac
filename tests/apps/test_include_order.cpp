// No include goes through a wall between folders, and each outside library has one door (docs/architecture.md).
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "catch.hpp"

namespace fs = std::filesystem;

namespace {

// Two wings and a hall: which folders a folder may include. The left wing (devices) knows no triangle and no file, the
// right one (contacts) no device and no file.
const std::map<std::string, std::set<std::string>> kMayInclude = {
    {"core", {}},
    // What both wings share.
    {"lp", {"core"}},
    {"device", {"core"}},
    {"coupling", {"core", "lp", "device"}},
    // The left wing.
    {"operator", {"core", "device"}},
    {"transport", {"core", "device", "coupling"}},
    {"servo", {"core", "lp", "device", "coupling", "transport"}},
    // The right wing.
    {"mesh", {"core"}},
    {"broadphase", {"core", "mesh"}},
    {"curve", {"core", "mesh"}},
    {"narrowphase", {"core", "mesh", "broadphase", "curve"}},
    {"feature", {"core", "mesh", "narrowphase"}},
    {"contact", {"core", "mesh", "narrowphase", "feature"}},
    {"resolve", {"core", "lp", "mesh", "contact"}},
    {"loop", {"core", "lp", "coupling", "mesh", "broadphase", "narrowphase", "feature", "contact", "resolve"}},
    // What asks it about paths.
    {"plan", {"core", "coupling", "mesh", "broadphase", "narrowphase", "contact", "resolve", "loop"}},
    // Files.
    {"import", {"core", "mesh"}},
    {"record", {"core"}},
    {"scene_file", {"core", "device", "coupling", "transport", "servo", "mesh", "resolve", "loop", "import"}},
    // The hall.
    {"session",
     {"core", "lp", "device", "operator", "coupling", "transport", "servo", "mesh", "broadphase", "narrowphase",
      "feature", "contact", "resolve", "loop", "import", "record", "scene_file"}},
    // The door for Python.
    {"python",
     {"core", "device", "servo", "transport", "mesh", "resolve", "loop", "plan", "import", "record", "scene_file",
      "session"}}};

std::string included(const std::string& line) {
  static const std::regex pattern(R"(^\s*#\s*include\s*["<]([^">]+)[">].*)");
  std::smatch m;
  return std::regex_match(line, m, pattern) ? m[1].str() : "";
}

// Part that the include path names ("" for what is not the project's).
std::string part_of(std::string path) {
  const std::string prefix = "tegotae/";
  if (path.rfind(prefix, 0) == 0) path = path.substr(prefix.size());
  const std::string first = path.substr(0, path.find('/'));
  return kMayInclude.count(first) ? first : "";
}

bool starts_with(const std::string& s, const std::string& prefix) {
  return s.rfind(prefix, 0) == 0;
}

// What a public header may include: its own kind, Eigen, and the system's headers.
bool may_be_public(const std::string& inc) {
  return starts_with(inc, "tegotae/") || starts_with(inc, "Eigen/") || inc.find('/') == std::string::npos;
}

// What is wrong with `line` in the file `file` (relative to the project, with /); empty when nothing is.
std::string violation(const std::string& file, const std::string& line) {
  static const std::regex in_part(R"((?:src|include/tegotae)/(\w+)/.*)");
  const std::string inc = included(line);
  std::smatch m;
  if (std::regex_match(file, m, in_part)) {
    const std::string self = m[1], other = part_of(inc);
    if (!kMayInclude.count(self)) return "folder " + self + " has no place in the order";
    if (!other.empty() && other != self && !kMayInclude.at(self).count(other))
      return self + " may not include " + other;
  }
  const bool test = starts_with(file, "tests/");
  if (!test && (starts_with(inc, "fcl/") || starts_with(inc, "ccd/")) && !starts_with(file, "src/narrowphase/"))
    return "FCL and libccd belong to src/narrowphase";
  if (!test && starts_with(inc, "assimp/") && !starts_with(file, "src/import/load"))
    return "assimp belongs to src/import/load*";
  if (!test && inc.size() > 4 && inc.substr(inc.size() - 4) == ".hxx" && !starts_with(file, "src/import/occt") &&
      !starts_with(file, "src/import/step_occt"))
    return "OpenCASCADE belongs to src/import/*occt*";
  static const std::pair<const char*, const char*> kOnlyIn[] = {
      {"draco/", "src/import/gltf_"},         {"meshoptimizer.h", "src/import/gltf_"},
      {"import/cgltf/", "src/import/gltf_"},  {"pugixml.hpp", "src/import/threemf_"},
      {"minizip/", "src/import/zip_archive"}, {"ompl/", "src/plan/ompl_"},
      {"xxhash.h", "src/mesh/content_sum"}};
  for (const auto& [library, place] : kOnlyIn)
    if (!test && starts_with(inc, library) && !starts_with(file, place))
      return std::string(library) + " belongs to " + place + "*";
  if (starts_with(file, "include/") && !inc.empty() && !may_be_public(inc)) return inc + " is not a public include";
  return "";
}

std::vector<std::pair<std::string, std::string>> project_lines() {
  std::vector<std::pair<std::string, std::string>> lines;
  const fs::path root = fs::path(TEGOTAE_TEST_DATA_DIR).parent_path();
  for (const char* folder : {"include", "src", "apps"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string ext = entry.path().extension().string();
      if (ext != ".hpp" && ext != ".cpp" && ext != ".h" && ext != ".c") continue;
      std::ifstream in(entry.path());
      for (std::string line; std::getline(in, line);)
        lines.emplace_back(fs::relative(entry.path(), root).generic_string(), line);
    }
  }
  return lines;
}

}  // namespace

TEST_CASE("the check sees an arrow through a wall", "[include]") {
  CHECK(violation("src/mesh/a.cpp", "#include \"tegotae/loop/scene.hpp\"") == "mesh may not include loop");
  CHECK(violation("src/mesh/a.cpp", "#  include <lp/simplex.hpp>") == "mesh may not include lp");
  CHECK(violation("include/tegotae/core/a.hpp", "#include \"tegotae/mesh/mass.hpp\"") == "core may not include mesh");
  CHECK(violation("src/loop/a.cpp", "#include \"device/device.hpp\"") == "loop may not include device");
  CHECK(violation("src/loop/a.cpp", "#include \"tegotae/import/load.hpp\"") == "loop may not include import");
  CHECK(violation("src/servo/a.cpp", "#include \"tegotae/mesh/mass.hpp\"") == "servo may not include mesh");
  CHECK(violation("src/transport/a.cpp", "#include \"tegotae/loop/scene.hpp\"") == "transport may not include loop");
  CHECK(violation("src/loop/a.cpp", "#include <fcl/fcl.h>") == "FCL and libccd belong to src/narrowphase");
  CHECK(violation("apps/a.cpp", "#include <assimp/scene.h>") == "assimp belongs to src/import/load*");
  CHECK(violation("src/import/a.cpp", "#include <pugixml.hpp>") == "pugixml.hpp belongs to src/import/threemf_*");
  CHECK(violation("src/import/a.cpp", "#include <BRep_Tool.hxx>") == "OpenCASCADE belongs to src/import/*occt*");
  CHECK(violation("src/plan/a.cpp", "#include <ompl/base/State.h>") == "ompl/ belongs to src/plan/ompl_*");
  CHECK(violation("src/plan/a.cpp", "#include \"tegotae/device/device.hpp\"") == "plan may not include device");
  CHECK(violation("include/tegotae/loop/a.hpp", "#include <toml++/toml.h>") == "toml++/toml.h is not a public include");
  CHECK(violation("include/tegotae/loop/a.hpp", "#include \"loop/a.hpp\"") == "loop/a.hpp is not a public include");
  CHECK(violation("include/tegotae/loop/a.hpp", "#include <vector>").empty());
  CHECK(violation("src/view/a.cpp", "int a;") == "folder view has no place in the order");
  CHECK(violation("src/session/a.cpp", "#include \"tegotae/core/pose.hpp\"").empty());
  CHECK(violation("src/session/a.cpp", "#include \"tegotae/servo/servo.hpp\"").empty());
  CHECK(violation("src/narrowphase/a.cpp", "#include <fcl/fcl.h>").empty());
  CHECK(violation("src/mesh/a.cpp", "// see \"tegotae/loop/scene.hpp\"").empty());
}

TEST_CASE("no include goes through a wall", "[include]") {
  const auto lines = project_lines();
  std::set<std::string> files, shm_files;
  std::string wrong;
  for (const auto& [file, line] : lines) {
    files.insert(file);
    // The examples are other people's drivers; they use the protocol's header and nothing of the library.
    if (line.find("shm_open(") != std::string::npos && !starts_with(file, "apps/examples/")) shm_files.insert(file);
    const std::string v = violation(file, line);
    if (!v.empty()) wrong += file + ": " + v + "\n";
  }
  CHECK(files.size() > 10);
  CHECK(wrong == "");
  CHECK(shm_files.size() <= 1);
  for (const std::string& file : shm_files) CHECK(starts_with(file, "src/transport/"));
}

TEST_CASE("every public header says what the shared library shows", "[include]") {
  std::map<std::string, int> shown;
  for (const auto& [file, line] : project_lines()) {
    if (!starts_with(file, "include/") || fs::path(file).extension() != ".hpp") continue;
    shown[file] += line == "namespace tegotae TEGOTAE_EXPORT {";
    CHECK((file + ": " + line) != file + ": namespace tegotae {");
  }
  CHECK(shown.size() > 10);
  for (const auto& [file, times] : shown) {
    const bool declares_nothing = file == "include/tegotae/core/export.hpp" ||
                                  file == "include/tegotae/core/version.hpp" || file == "include/tegotae/tegotae.hpp";
    INFO(file);
    CHECK(times == (declares_nothing ? 0 : 1));
  }
}

TEST_CASE("public headers include the standard headers of what they name", "[include]") {
  // Themselves, or by another public header. A standard header may have others along, in one compiler's library and not
  // in the next one's; <stdint.h> has no names in std.
  const std::pair<const char*, std::regex> named[] = {{"cstdint", std::regex(R"(std::u?int\d+_t)")},
                                                      {"string", std::regex(R"(std::string\b)")},
                                                      {"string_view", std::regex(R"(std::string_view)")},
                                                      {"vector", std::regex(R"(std::vector)")},
                                                      {"array", std::regex(R"(std::array)")},
                                                      {"optional", std::regex(R"(std::optional)")},
                                                      {"functional", std::regex(R"(std::function)")},
                                                      {"memory", std::regex(R"(std::(unique|shared|weak)_ptr)")},
                                                      {"atomic", std::regex(R"(std::atomic)")},
                                                      {"limits", std::regex(R"(std::numeric_limits)")}};
  std::map<std::string, std::set<std::string>> includes, needs;
  for (const auto& [file, line] : project_lines()) {
    if (!starts_with(file, "include/")) continue;
    includes[file.substr(8)].insert(included(line));
    for (const auto& [header, pattern] : named)
      if (std::regex_search(line, pattern)) needs[file.substr(8)].insert(header);
  }
  CHECK(needs.size() > 10);
  for (const auto& [file, headers] : needs) {
    std::set<std::string> reached;
    std::vector<std::string> next = {file};
    while (!next.empty()) {
      const std::string from = next.back();
      next.pop_back();
      for (const std::string& to : includes[from])
        if (reached.insert(to).second) next.push_back(to);
    }
    for (const std::string& header : headers) {
      INFO(file << " needs <" << header << ">");
      CHECK(reached.count(header) == 1);
    }
  }
}

TEST_CASE("the version is one", "[include]") {
  const fs::path root = fs::path(TEGOTAE_TEST_DATA_DIR).parent_path();
  std::ifstream in(root / "include/tegotae/core/version.hpp");
  const std::string text(std::istreambuf_iterator<char>(in), {});
  std::smatch numbers, whole;
  REQUIRE(std::regex_search(text, numbers, std::regex(R"(MAJOR (\d+)\n[^\n]*MINOR (\d+)\n[^\n]*PATCH (\d+)\n)")));
  REQUIRE(std::regex_search(text, whole, std::regex(R"re(VERSION_STRING "([0-9.]+)")re")));
  CHECK(whole[1].str() == numbers[1].str() + "." + numbers[2].str() + "." + numbers[3].str());
}

TEST_CASE("the README's code is the example that is built", "[include]") {
  const fs::path root = fs::path(TEGOTAE_TEST_DATA_DIR).parent_path();
  const auto text = [](const fs::path& path) {
    std::ifstream in(path);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const std::string example = text(root / "apps/examples/first_touch.cpp");
  REQUIRE(!example.empty());
  CHECK(text(root / "README.md").find("```cpp\n" + example + "```\n") != std::string::npos);
  CHECK(std::count(example.begin(), example.end(), '\n') <= 25);
}

TEST_CASE("the steps of a tick are where the document says", "[include]") {
  const fs::path root = fs::path(TEGOTAE_TEST_DATA_DIR).parent_path();
  std::ifstream in(root / "docs/architecture.md");
  const std::regex row(R"re(\| (\d+) \| [^|]+ \| `([\w:]+)` \| `([\w/.]+)` \|)re");
  int steps = 0;
  std::smatch m;
  for (std::string line; std::getline(in, line);) {
    if (!std::regex_match(line, m, row)) continue;
    INFO(line);
    CHECK(std::stoi(m[1]) == ++steps);
    std::ifstream file(root / m[3].str());
    const std::string text(std::istreambuf_iterator<char>(file), {});
    // Its definition: at the beginning of a line, with its type before it.
    CHECK(std::regex_search(text, std::regex("\\n\\w[^\\n;]* \\*?" + m[2].str() + "\\(")));
  }
  CHECK(steps == 13);
}
