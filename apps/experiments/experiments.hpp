#pragma once

#include <string>
#include <vector>

namespace tegotae::experiments {

struct Options {
  std::string name;                 ///< one of names()
  std::string out = "experiments";  ///< folder that the files are written to
  int seeds = 0;                    ///< runs of each kind that differ by their seed; 0: each experiment's own number
  int threads = 0;                  ///< 0: as many as the machine has
  bool quick = false;               ///< fewer cases, for tests
};

/// "wall", "insertion", ..., "all".
const std::vector<std::string>& names();

/// Runs one experiment or all, writes NAME/*.csv, NAME/summary.json and NAME/report.html under options.out, and prints
/// the claims. Results do not depend on the number of threads. Returns the exit code: 1 when a claim does not hold.
/// Throws Error for a folder that cannot be written.
int run(const Options& options);

}  // namespace tegotae::experiments
