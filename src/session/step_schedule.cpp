#include "session/step_schedule.hpp"

#include <time.h>

#include <algorithm>
#include <cerrno>

#include "tegotae/core/clock.hpp"

namespace tegotae {

namespace {
// A tick is followed by a rest of a tenth of it, or a period: the kernel stops a real-time thread that takes more than
// 95 % of a second for 50 ms, longer than the servo waits for a heartbeat.
constexpr std::int64_t kTickPerRest = 10;
}  // namespace

std::int64_t StepSchedule::wait() noexcept {
  const timespec t = {static_cast<time_t>(next_ns_ / 1'000'000'000), static_cast<long>(next_ns_ % 1'000'000'000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
  return monotonic_ns();
}

void StepSchedule::done(std::int64_t begin_ns, std::int64_t end_ns) noexcept {
  // A tick that took longer than a period is followed by the next, not by a burst that makes up for it.
  next_ns_ = std::max(next_ns_ + period_ns_, end_ns + std::min((end_ns - begin_ns) / kTickPerRest, period_ns_));
}

}  // namespace tegotae
