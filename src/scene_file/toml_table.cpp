#include "scene_file/toml_table.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/wide_text.hpp"
#include "import/file_check.hpp"
#include "scene_file/toml_levels.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

namespace {

const toml::table kEmptyTable;

std::string at(const std::string& file, const toml::source_region& where) {
  return where.begin ? file + ":" + std::to_string(where.begin.line) : file;
}

bool is_control(char c) {
  return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
}

/// Text has no zeros, and of other characters that are none next to nothing.
bool is_binary(const std::string& text) {
  constexpr std::ptrdiff_t kFew = 20;  // one in so many is too many
  const auto odd = [](char c) { return is_control(c) && c != '\t' && c != '\n' && c != '\r'; };
  return text.find('\0') != std::string::npos ||
         kFew * std::count_if(text.begin(), text.end(), odd) > static_cast<std::ptrdiff_t>(text.size());
}

/// Keys and values may hold line breaks and worse; a message is one line.
std::string one_line(std::string text) {
  std::replace_if(text.begin(), text.end(), is_control, '?');
  return text;
}

std::string type_name(const toml::node& node) {
  std::ostringstream s;
  s << node.type();
  return s.str();
}

double as_double(const toml::node& node) {
  return node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
}

std::string shown(double value) {
  std::ostringstream s;
  s << value;
  return s.str();
}

}  // namespace

std::string read_file(const std::string& path) {
  require_file(path);
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  if (in) text << in.rdbuf();
  if (!in) throw Error(ErrorKind::file, path + ": cannot be read (" + std::strerror(errno) + ")", {path, 0, {}, {}});
  return text.str();
}

toml::table parse_toml(const std::string& text, const std::string& path) {
  if (const char* encoding = wide_encoding(text))
    throw Error(ErrorKind::file, path + ": its text is in " + encoding + ", and TOML is UTF-8: save it as that",
                {path, 0, {}, {}});
  if (is_binary(text))
    throw Error(ErrorKind::file,
                path +
                    ": not a scene or study file: it is binary, and they are text (TOML); by their endings are read " +
                    kKindsOfFile,
                {path, 0, {}, {}});
  check_toml_levels(text, path);
  try {
    return toml::parse(text, path);
  } catch (const toml::parse_error& e) {
    const bool is_toml = std::filesystem::path(path).extension() == ".toml";
    throw Error(ErrorKind::file,
                at(path, e.source()) + ": not valid TOML: " + one_line(std::string(e.description())) +
                    (is_toml ? "" : "; is this a scene file?"),
                {path, static_cast<int>(e.source().begin.line), {}, {}});
  }
}

TomlTable::TomlTable(const toml::table& table, const std::string& file, const std::string& name,
                     std::initializer_list<const char*> known)
    : table_(table), file_(file), name_(name) {
  for (const auto& [key, node] : table_) {
    if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
    std::string list;
    for (const char* k : known) list += (list.empty() ? "" : ", ") + std::string(k);
    fail(std::string(key.str()), "unknown key (known here: " + list + ")");
  }
}

void TomlTable::fail(const std::string& key, const std::string& reason) const {
  const auto it = table_.find(key);
  const toml::source_region& where = it == table_.end() ? table_.source() : it->first.source();
  const std::string dotted = (name_.empty() ? "" : name_ + ".") + key;
  throw Error(ErrorKind::file, at(file_, where) + ": " + one_line(dotted + ": " + reason),
              {file_, static_cast<int>(where.begin.line), dotted, {}});
}

std::string TomlTable::text(const char* key) const {
  if (!has(key)) fail(key, "missing");
  return text(key, "");
}

std::string TomlTable::text(const char* key, const std::string& fallback) const {
  const toml::node* node = table_.get(key);
  if (!node) return fallback;
  if (!node->is_string()) fail(key, "must be a string, not " + type_name(*node));
  const std::string value = node->as_string()->get();
  if (value.empty()) fail(key, "must not be empty");
  if (std::any_of(value.begin(), value.end(), is_control)) fail(key, "must be one line of printable text");
  return value;
}

bool TomlTable::flag(const char* key, bool fallback) const {
  const toml::node* node = table_.get(key);
  if (!node) return fallback;
  if (!node->is_boolean()) fail(key, "must be true or false, not " + type_name(*node));
  return node->as_boolean()->get();
}

double TomlTable::number(const char* key, double fallback) const {
  const toml::node* node = table_.get(key);
  if (!node) return fallback;
  if (!node->is_number()) fail(key, "must be a number, not " + type_name(*node));
  const double value = as_double(*node);
  if (!std::isfinite(value)) fail(key, "must be finite");
  return value;
}

double TomlTable::positive(const char* key, double fallback) const {
  const double value = number(key, fallback);
  if (has(key) && !(value > 0)) fail(key, "must be greater than zero (it is " + shown(value) + ")");
  return value;
}

double TomlTable::at_least_zero(const char* key, double fallback) const {
  const double value = number(key, fallback);
  if (value < 0) fail(key, "must not be negative (it is " + shown(value) + ")");
  return value;
}

int TomlTable::whole(const char* key, int least, int most) const {
  const double value = number(key, -1);
  if (value >= least && value <= most && value == std::floor(value)) return static_cast<int>(value);
  fail(key, "must be a whole number from " + std::to_string(least) + " to " + std::to_string(most) + " (it is " +
                shown(value) + ")");
}

std::vector<double> TomlTable::numbers(const char* key, std::size_t least, std::size_t most) const {
  const toml::node* node = table_.get(key);
  const toml::array* array = node ? node->as_array() : nullptr;
  if (!array || array->size() < least || array->size() > most)
    fail(key, "must be a list of " + std::to_string(least) + (most > least ? " to " + std::to_string(most) : "") +
                  " numbers");
  std::vector<double> values;
  for (const toml::node& element : *array) {
    if (!element.is_number()) fail(key, "must be a list of numbers; one is " + type_name(element));
    values.push_back(as_double(element));
    if (!std::isfinite(values.back())) fail(key, "must be finite");
  }
  return values;
}

std::vector<std::string> TomlTable::texts(const char* key) const {
  const toml::node* node = table_.get(key);
  if (!node) return {};
  if (!node->is_array()) fail(key, "must be a list of strings, not " + type_name(*node));
  std::vector<std::string> values;
  for (const toml::node& element : *node->as_array()) {
    if (!element.is_string()) fail(key, "must be a list of strings; one is " + type_name(element));
    values.push_back(element.as_string()->get());
  }
  return values;
}

TomlTable TomlTable::table(const char* key, std::initializer_list<const char*> known) const {
  const toml::node* node = table_.get(key);
  if (node && !node->is_table()) fail(key, "must be a table, not " + type_name(*node));
  return TomlTable(node ? *node->as_table() : kEmptyTable, file_, name_.empty() ? key : name_ + "." + key, known);
}

std::vector<TomlTable> TomlTable::tables(const char* key, std::initializer_list<const char*> known) const {
  std::vector<TomlTable> all;
  const toml::node* node = table_.get(key);
  if (!node) return all;
  if (!node->is_array_of_tables()) fail(key, std::string("must be written [[") + key + "]]");
  for (const toml::node& element : *node->as_array())
    all.emplace_back(*element.as_table(), file_, name_.empty() ? key : name_ + "." + key, known);
  return all;
}

}  // namespace tegotae
