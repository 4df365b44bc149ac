#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>

#include "core/wide_text.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

// What the checks of text in mesh files share.

constexpr std::string_view kBlank = " \t\r\n";

inline bool is_one_of(char c, std::string_view set) {
  for (const char one : set)
    if (c == one) return true;
  return false;
}

/// Where `text` has a character of `set` first, its size when nowhere. In place of std::string_view::find_first_of(),
/// which calls memchr() for every character of files that have tens of millions.
inline std::size_t first_of(std::string_view text, std::string_view set) {
  std::size_t i = 0;
  while (i < text.size() && !is_one_of(text[i], set)) ++i;
  return i;
}

/// Where it has another character first from `i` on.
inline std::size_t first_not_of(std::string_view text, std::string_view set, std::size_t i = 0) {
  while (i < text.size() && is_one_of(text[i], set)) ++i;
  return i;
}

[[noreturn]] inline void refuse(const std::string& path, const std::string& why) {
  throw Error(path + ": " + why);
}

/// Refuses a file that has been packed, which its name does not tell.
inline void require_unpacked(const std::string& path, std::string_view bytes) {
  using namespace std::string_view_literals;
  constexpr std::pair<std::string_view, const char*> kPacked[] = {
      {"\x1f\x8b"sv, "gzip"},         {"PK\3\4"sv, "ZIP"},           {"BZh"sv, "bzip2"}, {"\3757zXZ\0"sv, "xz"},
      {"\x28\xb5\x2f\xfd"sv, "zstd"}, {"7z\xbc\xaf\x27\x1c"sv, "7z"}};
  for (const auto& [start, kind] : kPacked)
    if (bytes.substr(0, start.size()) == start)
      refuse(path, std::string("is packed by ") + kind + ", which is not read: unpack it first");
}

/// Refuses what is packed, and text in UTF-16 or UTF-32: these formats are of single bytes.
inline void require_single_bytes(const std::string& path, std::string_view bytes) {
  require_unpacked(path, bytes);
  if (const char* encoding = wide_encoding(bytes))
    refuse(path, std::string("its text is in ") + encoding + ", which this format is not: save it as UTF-8");
}

/// Whether bytes behind the end of a file's content are nothing but padding: blanks, and one and the same byte.
inline bool is_padding(std::string_view bytes) {
  bytes.remove_prefix(std::min(bytes.find_first_not_of(kBlank), bytes.size()));
  return bytes.find_first_not_of(bytes.substr(0, 1)) == bytes.npos;
}

/// What becomes of the text of a number that no double holds: 0 for the smallest, else infinite.
inline double beyond_double(std::string_view text) {
  const bool negative = text.substr(0, 1) == "-";
  text.remove_prefix(negative ? 1 : 0);
  const std::size_t exponent = text.find_first_of("eE");
  const bool small =
      exponent == text.npos ? text.find_first_of("0.") == 0 : text.substr(exponent + 1, 1).find('-') != text.npos;
  const double size = small ? 0 : std::numeric_limits<double>::infinity();
  return negative ? -size : size;
}

/// Takes the next word of `text`'s first line from it; false when that is not a T as a whole (a plus in front may be).
/// A number too large for a double is infinite: coordinates are judged after loading.
template <class T>
bool take_number(std::string_view& text, T& value) {
  text.remove_prefix(first_not_of(text, " \t\r"));
  std::string_view word = text.substr(0, first_of(text, kBlank));
  text.remove_prefix(word.size());
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size()) return false;
  if constexpr (std::is_floating_point_v<T>) {
    if (error == std::errc::result_out_of_range) {
      value = beyond_double(word);
      return true;
    }
  }
  return error == std::errc();
}

/// Takes the next word of `text`'s first line from it, a coordinate; false when it is none. Some programs write the
/// decimal comma of their country, which cannot be anything else there.
inline bool take_coordinate(std::string_view& text, double& value) {
  std::string_view rest = text;
  if (take_number(rest, value)) {
    text = rest;
    return true;
  }
  text.remove_prefix(first_not_of(text, " \t\r"));
  std::string word(text.substr(0, first_of(text, kBlank)));
  text.remove_prefix(word.size());
  std::replace(word.begin(), word.end(), ',', '.');
  std::string_view number = word;
  return take_number(number, value);
}

/// The number `word` with the value `value` as assimp reads it: with a digit in front, with no more digits before the
/// point than its integers hold, and with none behind that it drops although an exponent makes them count.
inline std::string plain_number(std::string_view word, double value) {
  constexpr std::size_t kIntegerDigits = 18, kDecimals = 15;
  if (word.substr(0, 1) == "+") word.remove_prefix(1);
  const std::string_view sign = word.substr(0, word.substr(0, 1) == "-" ? 1 : 0);
  word.remove_prefix(sign.size());
  const std::size_t exponent = word.find_first_of("eE"), end = std::min(exponent, word.size());
  const std::size_t point = std::min(word.find('.'), end);
  const bool dropped = exponent != word.npos && end - point > kDecimals + 1;
  if (std::isfinite(value) && (point > kIntegerDigits || dropped)) {
    char digits[32];
    return {digits, std::to_chars(digits, digits + sizeof digits, value, std::chars_format::scientific).ptr};
  }
  return std::string(sign) + (point == 0 ? "0" : "") + std::string(word);
}

}  // namespace tegotae
