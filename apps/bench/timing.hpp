#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "tegotae/core/latency_histogram.hpp"

namespace tegotae::bench {

/// Percentiles (µs) of times in ns, which are sorted for it; all NaN when there are none. A percentile is the smallest
/// time that at least that share does not exceed.
LatencySummary percentiles(std::vector<std::int64_t>& times_ns);

/// CPU time of the calling thread, ns: without what other programs and the host took meanwhile.
std::int64_t thread_cpu_ns() noexcept;
/// The same of all threads of this process.
std::int64_t process_cpu_ns() noexcept;

/// Runs `work` in a thread of its own under SCHED_FIFO where the system grants it, as a real contact loop would run;
/// what it throws is thrown here. Returns whether it was granted.
bool on_measuring_thread(const std::function<void()>& work);

/// Lets a busy real-time thread rest now and then: the kernel stops one that takes 95 % of a second, for 50 ms.
class Rest {
 public:
  /// Call outside the timed part.
  void pause_if_due();

 private:
  std::int64_t since_ns_ = 0;
};

}  // namespace tegotae::bench
