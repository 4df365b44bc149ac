#pragma once

#include <unistd.h>

#include <cstdio>
#include <string>

namespace tegotae::apps {

/// One line on standard error, replaced as the work goes on; nothing unless that is a terminal. Gone with the object.
class StatusLine {
 public:
  void say(const std::string& what) const {
    if (shown_) std::fprintf(stderr, "\r\033[K%s", what.c_str());
  }
  ~StatusLine() { say(""); }

 private:
  const bool shown_ = isatty(STDERR_FILENO) != 0;
};

}  // namespace tegotae::apps
