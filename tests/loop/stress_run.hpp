// One random script over one scene, every committed piece checked.
#pragma once

#include <cstdint>
#include <string>

#include "stress_scenes.hpp"
#include "tegotae/core/latency_histogram.hpp"

namespace tegotae::test {

struct StressOptions {
  std::string resolver = "qp";
  double budget = 0;  ///< s; 0: bounded by work alone
  int ticks = 100;
  double mu = 0;       ///< coefficient of friction of all parts
  int between = 1;     ///< poses checked inside a piece, on the two readings of its path in turn
  std::string record;  ///< folder for a scene file and a recording; empty: none
};

/// What happened; sums over scripts.
struct StressResult {
  std::int64_t scripts = 0, ticks = 0, substeps = 0;
  std::int64_t poses = 0;                                                               ///< asked of FCL
  std::int64_t intersecting = 0;                                                        ///< of those
  std::int64_t touching = 0, timed_out = 0, overflow = 0, infeasible = 0, stalled = 0;  ///< ticks
  std::int64_t out_of_time = 0, out_of_capacity = 0;  ///< ticks with a lag over the bound, by LagReason
  std::int64_t unexplained = 0;                       ///< TickReport::unexplained_lag_ticks
  std::int64_t late_unreported = 0;  ///< ticks whose CPU time passed the budget but that are not reported as timed out
  std::string first_intersecting, first_late;  ///< where
  double seconds_loop = 0, seconds_check = 0;

  void add(const StressResult& other);
};

/// `cpu` takes the thread CPU time of each tick.
StressResult run_stress_script(const StressScene& scene, unsigned seed, const StressOptions& options,
                               LatencyHistogram& cpu);

}  // namespace tegotae::test
