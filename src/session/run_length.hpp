#pragma once

namespace tegotae {

/// s, of the longest run: eleven days; far below where ticks or nanoseconds overflow.
inline constexpr double kMaxRunSeconds = 1e6;

}  // namespace tegotae
