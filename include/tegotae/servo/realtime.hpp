#pragma once

#include <string>

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// What to do when the system does not grant real-time scheduling.
enum class RealtimeConfig {
  enforce,  ///< refuse to start, with the reason
  ignore,   ///< run as well as possible; RealtimeReport names what is missing
};

/// What the system granted to the servo's thread.
struct RealtimeReport {
  bool fifo = false;           ///< SCHED_FIFO, priority 80
  bool memory_locked = false;  ///< mlockall: no page of the process is swapped out
  bool timer_slack = false;    ///< wake-ups are not batched
  int cpu = -1;                ///< CPU to which the thread is bound; -1: none
  std::string missing;         ///< what the system refused and why, in one line; empty when it granted everything
};

/// Requests real time for the calling thread: SCHED_FIFO, a lock on the memory that the process has now, no timer
/// slack. Binds the thread to `cpu` unless that is negative. Returns what the system granted.
RealtimeReport make_realtime(int cpu = -1);
/// Releases what was granted to the process and not to the thread: the lock on memory. Call it once for each report.
/// The lock ends with its last user.
void release_realtime(const RealtimeReport& granted) noexcept;

}  // namespace tegotae
