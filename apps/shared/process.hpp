#pragma once

#include <string>

namespace tegotae::apps {

/// To be called first in a program. Where it was started without standard input, output or error, /dev/null stands in,
/// so that no file that is opened later becomes one of them. Writes that nobody reads or that pass a limit of size fail
/// instead of ending the process.
void prepare_process();

/// To be called last: `code`, or 2 with a line on standard error when standard output could not be written to its end.
int finish_output(const std::string& program, int code);

}  // namespace tegotae::apps
