#include "shared/format.hpp"

#include <cstdarg>
#include <cstdio>

namespace tegotae::apps {

std::string format(const char* pattern, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(text, sizeof text, pattern, arguments);
  va_end(arguments);
  return text;
}

}  // namespace tegotae::apps
