#pragma once

#include <functional>
#include <string>

namespace tegotae::apps {

/// What a child may take.
struct ChildBounds {
  double seconds = 600;  ///< for one thing
  double megabytes = 0;  ///< of address space; 0: three quarters of the machine's memory
};

/// Runs `body` in a child process and returns the exit code that it returned: OpenCASCADE follows null pointers in some
/// damaged files, and then the child dies; it takes hours over others. `body` calls its argument with what it does
/// next. Throws Error for `file` when the child dies, or when it takes too long for one thing: then it is ended, and
/// the message is that it was not read, what it was at, and `hint`. A child that needs more memory says so and ends.
int watched_child(const std::string& file, const ChildBounds& bounds, const std::string& hint,
                  const std::function<int(const std::function<void(const std::string&)>&)>& body);

}  // namespace tegotae::apps
