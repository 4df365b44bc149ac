#pragma once

#include <functional>

namespace tegotae {

/// Calls `job(i)` for i = 0 to n - 1 on `threads` threads (0: all processors), in any order. `done(count)` (may be
/// empty) is told after each, one at a time. When one of them throws, no more begin and the first exception is thrown
/// when all have ended.
void parallel_for(int n, int threads, const std::function<void(int)>& job, const std::function<void(int)>& done);

}  // namespace tegotae
