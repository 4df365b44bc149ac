#pragma once

#include <memory>
#include <vector>

#include "bench/path.hpp"
#include "bench/scenes.hpp"
#include "bench/timing.hpp"
#include "session/pose_check.hpp"
#include "tegotae/loop/haptic_loop.hpp"

namespace tegotae::bench {

/// A closed-loop run along the scene's way. Times and counts are of the ticks in contact; one that was cut counts as in
/// contact, or a loop that freezes near a contact would look fast.
struct LoopFigures {
  LatencySummary tick_us{};      ///< wall clock
  LatencySummary tick_cpu_us{};  ///< CPU time of the loop's thread
  std::size_t ticks = 0;         ///< all
  std::size_t in_contact = 0;
  double contacts = 0;  ///< mean
  int contacts_max = 0;
  double limits = 0;           ///< mean
  double resolves = 0;         ///< mean
  double candidate_parts = 0;  ///< mean
  std::size_t cut = 0;         ///< ticks
  std::size_t overflow = 0;    ///< ticks
  double depth = 0;            ///< how deep the scene's tip went below z = 0, m; NaN without a tip
  bool fifo = false;           ///< measured under SCHED_FIFO
};

/// Poses of a run, for the checks after it.
struct LoopTrace {
  PoseCheck committed;       ///< an even sample of the committed poses
  std::int64_t checked = 0;  ///< their number
  /// An even sample of X and Y while in contact.
  std::vector<Pose> X, Y;
  struct Tick {
    Pose X, Y;
  };
  std::vector<Tick> ticks;  ///< all of the last run
  Pose start;               ///< X before it
};

/// Runs `rounds` rounds of the scene's pen at `speed`, a tick each millisecond of virtual time. `loop` must be where
/// the rounds begin, as after making it or a run.
LoopFigures measure_loop(const BenchScene& scene, HapticLoop& loop, const PenSpeed& speed, int rounds,
                         LoopTrace& trace);

}  // namespace tegotae::bench
