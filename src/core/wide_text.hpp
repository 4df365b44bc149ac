#pragma once

#include <cstddef>
#include <string_view>

namespace tegotae {

/// The encoding of a text that is not of single bytes, as some editors and shells save it: "UTF-16" or "UTF-32", known
/// by its byte order mark or by the zeros beside its first letters. Null: another one.
inline const char* wide_encoding(std::string_view text) {
  using namespace std::string_view_literals;
  if (text.substr(0, 4) == "\xff\xfe\0\0"sv || text.substr(0, 4) == "\0\0\xfe\xff"sv) return "UTF-32";
  if (text.substr(0, 2) == "\xff\xfe"sv || text.substr(0, 2) == "\xfe\xff"sv) return "UTF-16";
  // What is not text has no eight letters with zeros at the same places beside each.
  constexpr std::size_t kLetters = 8;
  const auto is_letter = [](char c) { return (c >= ' ' && c <= '~') || c == '\t' || c == '\r' || c == '\n'; };
  for (const std::size_t width : {4u, 2u}) {
    if (text.size() < kLetters * width) continue;
    for (const std::size_t at : {std::size_t{0}, width - 1}) {
      bool wide = true;
      for (std::size_t i = 0; i < kLetters * width; ++i)
        wide = wide && (i % width == at ? is_letter(text[i]) : text[i] == 0);
      if (wide) return width == 4 ? "UTF-32" : "UTF-16";
    }
  }
  return nullptr;
}

}  // namespace tegotae
