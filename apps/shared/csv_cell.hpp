#pragma once

#include <algorithm>
#include <string>

namespace tegotae::apps {

/// A cell of a CSV file between quotes (RFC 4180). A row is a line, so control characters become spaces.
inline std::string csv_quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const bool control = static_cast<unsigned char>(c) < 0x20;
    out += c == '"' ? std::string("\"\"") : std::string(1, control ? ' ' : c);
  }
  return out + '"';
}

/// The same, between quotes only where they are needed.
inline std::string csv_cell(const std::string& text) {
  const bool plain = std::none_of(text.begin(), text.end(),
                                  [](char c) { return c == ',' || c == '"' || static_cast<unsigned char>(c) < 0x20; });
  return plain ? text : csv_quoted(text);
}

}  // namespace tegotae::apps
