// Texts for tests with something else in them.
#pragma once

#include <string>

#include "catch.hpp"

namespace tegotae::test {

/// `text` with `to` for the first `from`, which must be in it.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

/// `text` with `to` for every `from`.
inline std::string replaced_all(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

}  // namespace tegotae::test
