#pragma once

#include <cstdint>

namespace tegotae::test {

/// From now on the calling thread may read the clock, sleep on it and end; every other system call is refused (ENOSYS)
/// and counted. A seccomp filter: it cannot be taken back. False when the system does not allow filters.
bool guard_system_calls();
std::uint64_t refused_system_calls();
/// Number of the last one refused; -1: none.
long last_refused_system_call();

}  // namespace tegotae::test
