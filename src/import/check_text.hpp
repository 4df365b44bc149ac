#pragma once

#include <algorithm>
#include <charconv>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

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

/// Takes the next word of `text`'s first line from it; false when that is no T as a whole (a plus in front may be). A
/// number too large for a double is infinite: coordinates are judged after loading.
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

}  // namespace tegotae
