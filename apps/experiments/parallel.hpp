#pragma once

#include <functional>
#include <string>

#include "experiments/experiments.hpp"
#include "shared/status_line.hpp"

namespace tegotae::experiments {

/// What an experiment needs to do its work.
struct Work {
  const Options& options;
  apps::StatusLine& status;

  /// The number of seeds: what the user said, or `full`, or `quick` for a quick look.
  int seeds(int full, int quick) const { return options.seeds > 0 ? options.seeds : options.quick ? quick : full; }
  /// Calls `job(i)` for i = 0 to n - 1 on all threads, in any order. Each job writes to its own place only, so that the
  /// result is the same for any number of threads. The first exception is thrown when all have ended.
  void each(const std::string& what, int n, const std::function<void(int)>& job) const;
};

}  // namespace tegotae::experiments
