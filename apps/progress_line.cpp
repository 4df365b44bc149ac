#include "progress_line.hpp"

#include <chrono>
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
  std::printf("\r\033[K%5.1f / %.1f s   depth %6.1f mm   %3d contacts   %5.2f N", progress_.t.load(),
              progress_.duration.load(), 1e3 * (progress_.depth.load() + depth_offset_), progress_.contacts.load(),
              progress_.force.load());
  std::fflush(stdout);
}

}  // namespace tegotae::apps
