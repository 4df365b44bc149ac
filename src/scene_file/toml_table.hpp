#pragma once

#include <toml++/toml.h>

#include <initializer_list>
#include <string>
#include <vector>

#include "tegotae/core/pose.hpp"

namespace tegotae {

/// The file at `path`. Throws Error when it cannot be read.
std::string read_file(const std::string& path);
/// Parses the text of the TOML file at `path`. Throws Error with file and line when it is not valid TOML.
toml::table parse_toml(const std::string& text, const std::string& path);

/// One table of a TOML file, read key by key. Everything wrong with it is an Error `file:line: table.key: reason`.
class TomlTable {
 public:
  /// `name` is the table's dotted name in messages (empty at the top level). Throws Error at a key not in `known`. The
  /// table must outlive the reader.
  TomlTable(const toml::table& table, const std::string& file, const std::string& name,
            std::initializer_list<const char*> known);

  bool has(const char* key) const { return table_.contains(key); }
  bool is_table(const char* key) const { return has(key) && table_.get(key)->is_table(); }

  std::string text(const char* key) const;  ///< required, not empty
  std::string text(const char* key, const std::string& fallback) const;
  bool flag(const char* key, bool fallback) const;
  double number(const char* key, double fallback) const;    ///< finite
  double positive(const char* key, double fallback) const;  ///< finite, > 0
  double at_least_zero(const char* key, double fallback) const;
  int whole(const char* key, int least, int most) const;  ///< required
  /// `count` finite numbers.
  std::vector<double> numbers(const char* key, std::size_t count) const { return numbers(key, count, count); }
  std::vector<double> numbers(const char* key, std::size_t least, std::size_t most) const;
  /// A list of strings, empty when the key is absent.
  std::vector<std::string> texts(const char* key) const;

  /// The table under `key` (an empty one when the key is absent), whose keys must be in `known`.
  TomlTable table(const char* key, std::initializer_list<const char*> known) const;
  /// The array of tables [[key]] (empty when the key is absent).
  std::vector<TomlTable> tables(const char* key, std::initializer_list<const char*> known) const;

  /// Throws the Error `file:line: table.key: reason`; the line of the table when it has no such key.
  [[noreturn]] void fail(const std::string& key, const std::string& reason) const;

 private:
  const toml::table& table_;
  std::string file_;
  std::string name_;
};

}  // namespace tegotae
