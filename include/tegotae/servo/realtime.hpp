#pragma once

#include <string>

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// What to do when the system does not grant real-time scheduling.
enum class RealtimeConfig {
  enforce,  ///< refuse to start, with the reason
  ignore,   ///< run as well as it goes; RealtimeReport tells what is missing
};

/// What the system granted to the servo's thread.
struct RealtimeReport {
  bool fifo = false;           ///< SCHED_FIFO
  bool memory_locked = false;  ///< mlockall: no page of the process is swapped out
  bool timer_slack = false;    ///< wake-ups are not batched
  int cpu = -1;                ///< that the thread is bound to; -1: none
  std::string missing;         ///< what was refused and why, in one line; empty when all was granted
};

/// Asks for all of it for the calling thread (memory: for the process as it is now), and to bind it to `cpu` unless
/// that is negative.
RealtimeReport make_realtime(int cpu = -1);
/// Gives back, once, what was granted to the process and not to the thread: the lock on memory, which goes when nobody
/// else has asked for it.
void release_realtime(const RealtimeReport& granted) noexcept;

}  // namespace tegotae
