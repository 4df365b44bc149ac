#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <iterator>
#include <string_view>

#include "import/file_check.hpp"
#include "import/read_parts.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

constexpr std::string_view kMagic = "ISO-10303-21";
// Beginnings of the schema names of AP203, AP214 and AP242 in all their editions.
constexpr std::array<std::string_view, 6> kSchemas = {"CONFIG_CONTROL_DESIGN", "AP203", "CCD_CLA",
                                                      "AUTOMOTIVE_DESIGN",     "AP214", "AP242"};

bool known_schema(std::string_view name) {
  return std::any_of(kSchemas.begin(), kSchemas.end(),
                     [&](std::string_view s) { return name.substr(0, s.size()) == s; });
}

/// The first name in FILE_SCHEMA(('NAME ...')), in capitals; empty when there is none.
std::string schema_of(std::string_view bytes) {
  std::size_t at = bytes.find("FILE_SCHEMA");
  if (at == std::string_view::npos) return "";
  at = bytes.find('\'', at);
  if (at == std::string_view::npos) return "";
  const std::size_t end = bytes.find_first_of("' {\r\n", at + 1);
  if (end == std::string_view::npos) return "";
  std::string name(bytes.substr(at + 1, end - at - 1));
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::toupper(c); });
  return name;
}

}  // namespace

bool is_step(const std::string& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".step" || extension == ".stp") return true;
  std::ifstream file(path, std::ios::binary);
  std::array<char, kMagic.size()> start{};
  file.read(start.data(), start.size());
  return file && std::string_view(start.data(), start.size()) == kMagic;
}

std::string check_step(const std::string& path) {
  std::string bytes = read_bytes(path);
  const std::string_view all(bytes);
  const std::size_t begin = all.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) throw Error(path + ": empty file");
  if (all.substr(begin, kMagic.size()) != kMagic) throw Error(path + ": damaged: it does not begin with ISO-10303-21");
  const std::size_t end = all.rfind("END-ISO-10303-21;");
  if (end == std::string_view::npos) throw Error(path + ": truncated: it has no END-ISO-10303-21");
  const std::string schema = schema_of(all);
  if (schema.empty()) throw Error(path + ": damaged: it names no schema (FILE_SCHEMA)");
  if (!known_schema(schema))
    throw Error(path + ": unknown STEP schema " + schema + " (known: AP203, AP214, AP242); export one of these");
  return bytes;
}

}  // namespace tegotae
