#pragma once

#include <cstdint>

namespace tegotae {

/// When a contact loop's ticks begin in real time: at most once a period.
class StepSchedule {
 public:
  explicit StepSchedule(std::int64_t period_ns) : period_ns_(period_ns) {}

  /// The first tick is due now.
  void begin(std::int64_t now_ns) noexcept { next_ns_ = now_ns; }
  /// Sleeps until the next tick is due; the time then.
  std::int64_t wait() noexcept;
  /// The tick that began at `begin_ns` is over at `end_ns`.
  void done(std::int64_t begin_ns, std::int64_t end_ns) noexcept;

 private:
  std::int64_t period_ns_;
  std::int64_t next_ns_ = 0;
};

}  // namespace tegotae
