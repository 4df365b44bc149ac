#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <vector>

#include "import/check_text.hpp"
#include "import/file_check.hpp"
#include "import/read_parts.hpp"
#include "import/step_entities.hpp"
#include "import/step_lists.hpp"
#include "import/utf8.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

constexpr std::string_view kMagic = "ISO-10303-21";
// Beginnings of the schema names of AP203, AP214 and AP242 in all their editions.
constexpr std::array<std::string_view, 6> kSchemas = {"CONFIG_CONTROL_DESIGN", "AP203", "CCD_CLA",
                                                      "AUTOMOTIVE_DESIGN",     "AP214", "AP242"};

bool known_schema(const std::string& name) {
  return std::any_of(kSchemas.begin(), kSchemas.end(),
                     [&](std::string_view s) { return name.compare(0, s.size(), s) == 0; });
}

/// The names in FILE_SCHEMA(('NAME ...', ...)), in capitals.
std::vector<std::string> schemas_of(std::string_view bytes) {
  std::vector<std::string> names;
  std::size_t at = bytes.find("FILE_SCHEMA");
  if (at == std::string_view::npos) return names;
  std::string_view list = bytes.substr(at, bytes.find(';', at) - at);
  while ((at = list.find('\'')) != std::string_view::npos) {
    list.remove_prefix(at + 1);
    const std::string_view text = list.substr(0, list.find('\''));
    list.remove_prefix(std::min(text.size() + 1, list.size()));
    std::string name(text.substr(0, text.find_first_of(" {\r\n")));
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::toupper(c); });
    if (!name.empty()) names.push_back(std::move(name));
  }
  return names;
}

}  // namespace

bool is_step(const std::string& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".step" || extension == ".stp") return true;
  std::error_code none;
  if (!std::filesystem::is_regular_file(path, none)) return false;  // a pipe would be waited for, and lose its start
  std::ifstream file(path, std::ios::binary);
  std::array<char, kMagic.size()> start{};
  file.read(start.data(), start.size());
  return file && std::string_view(start.data(), start.size()) == kMagic;
}

std::string check_step(const std::string& path) {
  std::string bytes = read_bytes(path);
  require_single_bytes(path, bytes);
  // Names in Latin-1, which older programs write, are no reason to lose letters.
  bytes = plain_step(path, to_utf8(bytes));
  const std::string_view all(bytes);
  const std::size_t begin = all.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) throw Error(path + ": empty file");
  if (all.substr(begin, kMagic.size()) != kMagic) throw Error(path + ": damaged: it does not begin with ISO-10303-21");
  const std::size_t end = all.rfind("END-ISO-10303-21");
  const std::size_t semicolon = end == all.npos ? all.npos : all.find_first_not_of(kBlank, end + 16);
  if (semicolon == all.npos || all[semicolon] != ';') throw Error(path + ": truncated: it has no END-ISO-10303-21");
  const std::vector<std::string> schemas = schemas_of(all);
  if (schemas.empty()) throw Error(path + ": damaged: it names no schema (FILE_SCHEMA)");
  if (std::none_of(schemas.begin(), schemas.end(), known_schema))
    throw Error(path + ": unknown STEP schema " + schemas.front() +
                " (known: AP203, AP214, AP242); export one of these");
  bytes.erase(end + 16, semicolon - end - 16);  // OpenCASCADE wants the two together
  return rename_unfilled(path, std::move(bytes));
}

}  // namespace tegotae
