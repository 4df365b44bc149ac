#pragma once

#include "bench/measure_loop.hpp"

namespace tegotae::bench {

/// One press of a part on its seat. Times are in ticks of 1 ms; NaN where it did not come to that.
struct SeatFigures {
  LatencySummary rest_us{};    ///< wall clock of the ticks at rest
  LatencySummary moving_us{};  ///< of the ticks in contact, or cut, besides
  double arrival_ms = 0;       ///< from the tick in which the pen passes the seat to that in which the part is there
  double above_seat = 0;       ///< where the part rests, m over its seat
  double slide_mm_s = 0;       ///< how fast the part goes aside while the pen does
  double off_ms = 0;           ///< from the tick in which the pen is off the seat to that in which the part follows it
  std::size_t cut = 0;         ///< ticks
  std::size_t ticks = 0;       ///< all
};

/// Runs the scene's seat pen at hand speed: down, 0.5 s of rest, aside and back, up. `scene.seat` is set, and `loop` is
/// where the pen begins.
SeatFigures measure_seat(const BenchScene& scene, HapticLoop& loop, LoopTrace& trace);

}  // namespace tegotae::bench
