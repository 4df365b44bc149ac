#include "tegotae/servo/realtime.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>

#include <cerrno>
#include <cstring>
#include <mutex>

namespace tegotae {

namespace {

// Above ordinary real-time threads such as sound servers, below the kernel's own at 99.
constexpr int kServoPriority = 80;
// The least that the kernel takes; 0 would restore the default of 50 µs.
constexpr unsigned long kTimerSlackNs = 1;

// The lock on memory is the process's: the last servo that asked for it gives it back.
std::mutex memory_mutex;
int memory_users = 0;

bool lock_memory() {
  const std::lock_guard<std::mutex> hold(memory_mutex);
  // Not MCL_FUTURE: under a limit on locked memory it makes later allocations of the application fail, and the servo
  // touches only memory that it has by now. Each servo locks anew what has come since the last.
  if (mlockall(MCL_CURRENT) != 0) return false;
  ++memory_users;
  return true;
}

int bind_to(int cpu) {
  if (cpu >= CPU_SETSIZE) return EINVAL;
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<unsigned>(cpu), &set);
  return pthread_setaffinity_np(pthread_self(), sizeof set, &set);
}

}  // namespace

RealtimeReport make_realtime(int cpu) {
  RealtimeReport report;
  const auto refused = [&report](const std::string& what, int error) {
    report.missing += std::string(report.missing.empty() ? "" : "; ") + what + ": " + std::strerror(error);
  };
  sched_param parameters{};
  parameters.sched_priority = kServoPriority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  report.fifo = error == 0;
  if (!report.fifo) refused("SCHED_FIFO", error);
  report.memory_locked = lock_memory();
  if (!report.memory_locked) refused("mlockall", errno);
  report.timer_slack = prctl(PR_SET_TIMERSLACK, kTimerSlackNs) == 0;
  if (!report.timer_slack) refused("timer slack", errno);
  if (cpu >= 0) {
    const int unbound = bind_to(cpu);
    if (unbound == 0)
      report.cpu = cpu;
    else
      refused("CPU " + std::to_string(cpu), unbound);
  }
  return report;
}

void release_realtime(const RealtimeReport& granted) noexcept {
  if (!granted.memory_locked) return;
  const std::lock_guard<std::mutex> hold(memory_mutex);
  if (--memory_users == 0) munlockall();
}

}  // namespace tegotae
