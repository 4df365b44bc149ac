#pragma once

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "tegotae/core/error.hpp"

namespace tegotae {

// What the checks of text in mesh files share.

constexpr std::string_view kBlank = " \t\r\n";

[[noreturn]] inline void refuse(const std::string& path, const std::string& why) {
  throw Error(path + ": " + why);
}

/// Takes the next word of `text`'s first line from it; false when that is no T as a whole (a plus in front may be). A
/// number too large for a
/// double is a number, and leaves `value` as it was: coordinates are judged after loading.
template <class T>
bool take_number(std::string_view& text, T& value) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r"), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(kBlank));
  text.remove_prefix(word.size());
  const std::size_t plus = word.size() > 1 && word[0] == '+' && word[1] != '-' ? 1 : 0;
  const auto [end, error] = std::from_chars(word.data() + plus, word.data() + word.size(), value);
  const bool number = error == std::errc() || (std::is_floating_point_v<T> && error == std::errc::result_out_of_range);
  return number && end == word.data() + word.size();
}

}  // namespace tegotae
