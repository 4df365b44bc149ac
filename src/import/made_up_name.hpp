#pragma once

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <string>

namespace tegotae {

/// Whether a program made up the name of a thing that nobody named: none, a number, or one of `words` (small letters)
/// with nothing but a number after it, as "Node_12".
inline bool is_made_up(std::string name, std::initializer_list<const char*> words) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  std::size_t begin = 0;
  for (const std::string word : words)
    if (name.rfind(word, 0) == 0) begin = std::max(begin, word.size());
  return name.find_first_not_of("0123456789 ._-", begin) == std::string::npos;
}

}  // namespace tegotae
