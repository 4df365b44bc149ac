// docs/device-protocol.md says what shm.h says, and its programs are those that are built and run.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "catch.hpp"
#include "tegotae/device/device.hpp"
#include "tegotae/device/shm.h"

namespace {

const std::filesystem::path kRoot = std::filesystem::path(TEGOTAE_TEST_DATA_DIR).parent_path();

std::string text(const char* path) {
  std::ifstream in(kRoot / path);
  return std::string(std::istreambuf_iterator<char>(in), {});
}

struct Field {
  std::size_t offset;
  std::string name, type;
};

const std::map<std::string, std::size_t> kSize = {{"uint64_t", 8},          {"int64_t", 8}, {"uint32_t", 4},
                                                  {"int32_t", 4},           {"double", 8},  {"char", 1},
                                                  {"tegotae_shm_plane", 64}};
const std::map<std::string, std::size_t> kNumber = {
    {"TEGOTAE_SHM_NAME", TEGOTAE_SHM_NAME},
    {"TEGOTAE_SHM_PLANES", TEGOTAE_SHM_PLANES},
    {"TEGOTAE_SHM_REASONS", TEGOTAE_SHM_REASONS},
    {"TEGOTAE_SHM_WORDS(tegotae_shm_device)", TEGOTAE_SHM_WORDS(tegotae_shm_device)},
    {"TEGOTAE_SHM_WORDS(tegotae_shm_application)", TEGOTAE_SHM_WORDS(tegotae_shm_application)},
    {"TEGOTAE_SHM_WORDS(tegotae_shm_statistics)", TEGOTAE_SHM_WORDS(tegotae_shm_statistics)}};

/// The fields of a struct of shm.h, laid out by the rules of C (natural alignment; TEGOTAE_SHM_ALIGN is 64).
std::vector<Field> fields(const std::string& name, std::size_t& size) {
  const std::string header = text("include/tegotae/device/shm.h");
  std::size_t begin = header.find("struct " + name + " {");
  REQUIRE(begin != std::string::npos);
  const std::string body = header.substr(begin, header.find("\n};", begin) - begin + 1);
  static const std::regex declaration(R"(\n +(TEGOTAE_SHM_ALIGN )?(?:struct )?(\w+) (\w+)(?:\[([^\]]+)\])?;)");
  std::vector<Field> found;
  std::size_t at = 0;
  for (std::sregex_iterator i(body.begin(), body.end(), declaration), none; i != none; ++i) {
    const std::smatch& m = *i;
    const std::size_t one = kSize.at(m[2]);
    const std::size_t align = m[1].matched ? 64 : std::min<std::size_t>(one, 8);
    std::size_t count = 1;
    std::string type = m[2];
    if (m[4].matched) {
      count = kNumber.count(m[4]) ? kNumber.at(m[4]) : std::stoul(m[4]);
      type += "[" + std::to_string(count) + "]";
    }
    at = (at + align - 1) / align * align;
    found.push_back({at, m[3], type});
    at += one * count;
  }
  size = at;
  return found;
}

}  // namespace

TEST_CASE("every field of the segment is in the document, with its offset and type", "[protocol]") {
  const std::string document = text("docs/device-protocol.md");
  const std::map<std::string, std::size_t> structs = {{"tegotae_shm_segment", sizeof(tegotae_shm_segment)},
                                                      {"tegotae_shm_device", sizeof(tegotae_shm_device)},
                                                      {"tegotae_shm_application", sizeof(tegotae_shm_application)},
                                                      {"tegotae_shm_plane", sizeof(tegotae_shm_plane)},
                                                      {"tegotae_shm_statistics", sizeof(tegotae_shm_statistics)}};
  for (const auto& [name, size] : structs) {
    INFO(name);
    std::size_t laid_out = 0;
    const std::vector<Field> all = fields(name, laid_out);
    // The compiler agrees with the layout that is looked for in the document; the segment ends on its alignment.
    CHECK((laid_out + 63) / 64 * 64 >= size);
    CHECK(laid_out <= size);
    const std::string heading = name == "tegotae_shm_segment" ? "## The segment\n" : "### " + name + "\n";
    const std::size_t begin = document.find(heading);
    REQUIRE(begin != std::string::npos);
    const std::string section = document.substr(begin, document.find("\n##", begin + 4) - begin);
    std::size_t rows = 0;
    for (std::size_t at = section.find("\n| "); at != std::string::npos; at = section.find("\n| ", at + 1)) ++rows;
    CHECK(rows == all.size() + 1);  // and the headings; no row too many
    for (const Field& f : all) {
      const std::string row = "\n| " + std::to_string(f.offset) + " | `" + f.name + "` | " + f.type + " | ";
      INFO(row);
      CHECK(section.find(row) != std::string::npos);
    }
  }
  // What the compiler says, where the rules above could be wrong.
  std::size_t end = 0;
  CHECK(fields("tegotae_shm_application", end).back().offset == offsetof(tegotae_shm_application, planes));
  CHECK(end == sizeof(tegotae_shm_application));
  CHECK(fields("tegotae_shm_segment", end).back().offset == offsetof(tegotae_shm_segment, statistics));
}

TEST_CASE("every reason is in the document, with its words for a person", "[protocol]") {
  const std::string document = text("docs/device-protocol.md");
  const std::string header = text("include/tegotae/device/shm.h");
  static const std::regex reason(R"((TEGOTAE_SHM_REASON_\w+) = (\d+))");
  int found = 0;
  for (std::sregex_iterator i(header.begin(), header.end(), reason), none; i != none; ++i, ++found) {
    const auto code = static_cast<tegotae::ForceOff>(std::stoul((*i)[2]));
    const std::string row = "| " + (*i)[2].str() + " | `" + (*i)[1].str() + "` | " + tegotae::to_string(code) + " |\n";
    INFO(row);
    CHECK(document.find(row) != std::string::npos);
  }
  CHECK(found == 17);
}

TEST_CASE("the document's programs are those that are built and run", "[protocol]") {
  const std::string document = text("docs/device-protocol.md");
  CHECK(document.find("```c\n" + text("apps/examples/driver.c") + "```\n") != std::string::npos);
  CHECK(document.find("```python\n" + text("apps/examples/reader.py") + "```\n") != std::string::npos);
}
