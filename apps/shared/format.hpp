#pragma once

#include <string>

namespace tegotae::apps {

/// As std::printf, into a string; up to 511 characters.
std::string format(const char* pattern, ...) __attribute__((format(printf, 1, 2)));

}  // namespace tegotae::apps
