#pragma once

#include <string>

namespace tegotae {

/// `text` if it is valid UTF-8; otherwise it is taken for Latin-1 and converted.
std::string to_utf8(const std::string& text);

/// `text` in UTF-8 and on one line, as scene files and notes want it: control characters become spaces.
std::string printable(const std::string& text);

}  // namespace tegotae
