#include "shared/progress_line.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>

namespace tegotae::apps {

namespace {
// Fast enough to look alive, slow enough not to take time from the loops.
constexpr std::chrono::milliseconds kPeriod(100);
}  // namespace

ProgressLine::ProgressLine(const RunProgress& progress, double depth_offset, bool show)
    : progress_(progress), depth_offset_(depth_offset) {
  if (!show) return;
  thread_ = std::thread([this] {
    std::unique_lock<std::mutex> lock(mutex_);
    while (!wake_.wait_for(lock, kPeriod, [this] { return ended_; })) print();
    std::fputs("\r\033[K", stdout);
    std::fflush(stdout);
  });
}

ProgressLine::~ProgressLine() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void ProgressLine::print() const {
  if (const double checked = progress_.checked.load(); checked >= 0) {
    std::printf("\r\033[Kasking FCL about the poses: %.0f %%", 100 * checked);
    std::fflush(stdout);
    return;
  }
  const double duration = progress_.duration.load();
  std::printf("\r\033[K%5.1f ", progress_.t.load());
  if (std::isfinite(duration)) std::printf("/ %.1f ", duration);
  std::printf("s   depth %6.1f mm   %3d contacts   %5.2f N", 1e3 * (progress_.depth.load() + depth_offset_),
              progress_.contacts.load(), progress_.force.load());
  const LagReason lag = progress_.lag_reason.load();
  if (lag != LagReason::none && lag != LagReason::contact) std::printf("   held back: %s", to_string(lag));
  if (progress_.held.load()) std::printf("   held fast in its fit");
  if (!progress_.device.load()) std::printf("   no device, waiting");
  std::fflush(stdout);
}

}  // namespace tegotae::apps
