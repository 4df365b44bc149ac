#pragma once

#include <string>
#include <vector>

namespace tegotae::bench {

/// What stands for the start among the scenes.
inline constexpr const char* kStart = "start";

struct BenchOptions {
  std::vector<std::string> scenes;  ///< of scene_names(), or kStart; empty: all
  bool quick = false;               ///< one round, few poses: for tests
  bool budgets = false;             ///< also with other tick budgets
  double mu = 0;                    ///< above 0: also with friction between the parts
  bool json = false;
  std::string resolver;  ///< empty: the library's default
  std::string markdown;  ///< file whose generated part is to be replaced; empty: none
  std::string command;   ///< as typed, for the file
};

/// Measures and reports on stdout. Returns the exit code: kRunFailed when a committed pose intersects.
int run_bench(const BenchOptions& options);

}  // namespace tegotae::bench
