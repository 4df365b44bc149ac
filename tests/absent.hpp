#pragma once

#include <string>

namespace tegotae::test {

/// Notes that a file or tool which a test needs is not there, with a line that says so. The run then ends with 77
/// instead of 0, which ctest reports as skipped: a test whose files are absent has not passed. A failure is a failure
/// still.
void note_absent(const std::string& what);

}  // namespace tegotae::test
