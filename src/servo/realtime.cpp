#include "tegotae/servo/realtime.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>

#include <cerrno>
#include <cstring>

namespace tegotae {

namespace {
// Above ordinary real-time threads such as sound servers, below the kernel's own at 99.
constexpr int kPriority = 80;
// The least that the kernel takes; 0 would restore the default of 50 µs.
constexpr unsigned long kTimerSlackNs = 1;
}  // namespace

RealtimeReport make_realtime() {
  RealtimeReport report;
  const auto refused = [&report](const char* what, int error) {
    report.missing += std::string(report.missing.empty() ? "" : "; ") + what + ": " + std::strerror(error);
  };
  sched_param parameters{};
  parameters.sched_priority = kPriority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  report.fifo = error == 0;
  if (!report.fifo) refused("SCHED_FIFO", error);
  // Not MCL_FUTURE: under a limit on locked memory it makes later allocations of the application fail, and the servo
  // touches only memory that it has by now.
  report.memory_locked = mlockall(MCL_CURRENT) == 0;
  if (!report.memory_locked) refused("mlockall", errno);
  report.timer_slack = prctl(PR_SET_TIMERSLACK, kTimerSlackNs) == 0;
  if (!report.timer_slack) refused("timer slack", errno);
  return report;
}

}  // namespace tegotae
