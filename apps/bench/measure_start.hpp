#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tegotae::bench {

/// How long it takes from the names of mesh files to a loop that ticks, wall clock.
struct StartFigures {
  std::string format;  ///< of the large part's file
  std::size_t triangles = 0;
  double first_s = 0;   ///< with an empty cache
  double second_s = 0;  ///< with the cache that the first start left, the least of three
};

/// Starts with a shaft of a million triangles (`quick`: 40 k) as a fixed part and a small one in hand beside it, for
/// each format. Sets the folder of the cache, and leaves it as the programs have it.
std::vector<StartFigures> measure_starts(bool quick);

}  // namespace tegotae::bench
