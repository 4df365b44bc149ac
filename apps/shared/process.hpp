#pragma once

#include <string>

namespace tegotae::apps {

/// Call this first in a program. It opens /dev/null in place of a missing standard input, output or error, so that no
/// file opened later becomes one of them. Writes to a closed pipe or beyond a size limit fail instead of ending the
/// process.
void prepare_process();

/// Call this last: returns `code`, or 2 with a line on standard error when standard output could not be written to its
/// end.
int finish_output(const std::string& program, int code);

}  // namespace tegotae::apps
