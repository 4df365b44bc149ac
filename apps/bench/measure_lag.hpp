#pragma once

#include <vector>

#include "bench/measure_loop.hpp"

namespace tegotae::bench {

/// How far a run was from what it would have been without a budget, under the same pen, tick by tick: what people feel
/// of ticks that were cut.
struct LagFigures {
  /// Of X, m: between the two centers of mass, and the angle between them times the part's radius.
  double p50 = 0, p99 = 0, most = 0;
  double force_rms = 0;    ///< of the coupling's springs without a budget, N, in the ticks in which they pull
  double error_rms = 0;    ///< of the difference in the same ticks, N
  double error_share = 0;  ///< one over the other; NaN where nothing pulls
  double error_most = 0;   ///< N
  std::size_t ticks = 0;   ///< so many of the run's first ticks were compared
};

/// Leads `unlimited`, a loop without a budget that is where the run of `trace` began, by the pen of that run, for half
/// a minute of CPU time at most: where surfaces of 180 k triangles slide on each other its ticks take up to seconds.
LagFigures measure_lag(const BenchScene& scene, HapticLoop& unlimited, const LoopTrace& trace);
/// The scene of such a loop, with its held part at `start`.
Scene without_budget(Scene scene, const Pose& start);

}  // namespace tegotae::bench
