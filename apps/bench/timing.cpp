#include "bench/timing.hpp"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <thread>

#include "tegotae/core/clock.hpp"
#include "tegotae/servo/realtime.hpp"

namespace tegotae::bench {
namespace {

// Busy 20 ms, then 3 ms rest: 87 %.
constexpr std::int64_t kBusyNs = 20'000'000;
constexpr std::chrono::milliseconds kPause(3);

std::int64_t cpu_ns(clockid_t clock) noexcept {
  timespec t;
  clock_gettime(clock, &t);
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

}  // namespace

LatencySummary percentiles(std::vector<std::int64_t>& times_ns) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (times_ns.empty()) return {kNone, kNone, kNone, kNone};
  std::sort(times_ns.begin(), times_ns.end());
  const auto at = [&](double share) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(times_ns.size())));
    return 1e-3 * static_cast<double>(times_ns[std::max<std::size_t>(rank, 1) - 1]);
  };
  return {at(0.5), at(0.99), at(0.999), at(1)};
}

std::int64_t thread_cpu_ns() noexcept {
  return cpu_ns(CLOCK_THREAD_CPUTIME_ID);
}

std::int64_t process_cpu_ns() noexcept {
  return cpu_ns(CLOCK_PROCESS_CPUTIME_ID);
}

bool on_measuring_thread(const std::function<void()>& work) {
  bool fifo = false;
  std::exception_ptr failure;
  std::thread thread([&] {
    fifo = make_realtime().fifo;
    try {
      work();
    } catch (...) {
      failure = std::current_exception();
    }
  });
  thread.join();
  if (failure) std::rethrow_exception(failure);
  return fifo;
}

void Rest::pause_if_due() {
  const std::int64_t now = monotonic_ns();
  if (since_ns_ == 0) since_ns_ = now;
  if (now - since_ns_ < kBusyNs) return;
  std::this_thread::sleep_for(kPause);
  since_ns_ = monotonic_ns();
}

}  // namespace tegotae::bench
