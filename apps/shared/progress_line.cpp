#include "shared/progress_line.hpp"

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>

#include "core/number_text.hpp"
#include "shared/format.hpp"
#include "shared/status_line.hpp"

namespace tegotae::apps {

namespace {
// Fast enough to look alive, slow enough not to take time from the loops.
constexpr std::chrono::milliseconds kPeriod(100);
}  // namespace

ProgressLine::ProgressLine(const RunProgress& progress, bool show)
    : progress_(progress), terminal_(show && isatty(STDOUT_FILENO) != 0) {
  if (!terminal_ && !progress_in_pipes()) return;
  thread_ = std::thread([this] {
    std::unique_lock<std::mutex> lock(mutex_);
    while (!wake_.wait_for(lock, kPeriod, [this] { return ended_; })) print();
    if (terminal_) std::fputs("\r\033[K", stdout);
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
  if (progress_.duration.load() == 0) return;  // what is built before the run has words of its own
  if (!terminal_ && !pipe_line_is_due()) return;
  FILE* const to = terminal_ ? stdout : stderr;
  std::fprintf(to, terminal_ ? "\r\033[K%s" : "%s\n", text().c_str());
  std::fflush(to);
}

std::string ProgressLine::text() const {
  if (const double checked = progress_.checked.load(); checked >= 0)
    return format("asking FCL about the poses: %.0f %%", 100 * checked);
  const double duration = progress_.duration.load();
  std::string text = format("%5.1f ", progress_.t.load());
  if (std::isfinite(duration)) text += format("/ %.1f ", duration);
  text += format("s   depth %6s mm   %3d contacts   %5.2f N", fixed_text(1e3 * progress_.depth.load(), 1).c_str(),
                 progress_.contacts.load(), progress_.force.load());
  const LagReason lag = progress_.lag_reason.load();
  if (lag == LagReason::time)
    text += "   held back: the tick ended first";
  else if (lag != LagReason::none && lag != LagReason::contact)
    text += std::string("   held back: ") + to_string(lag);
  if (progress_.held.load()) text += "   held fast in its fit";
  if (!progress_.device.load()) text += "   no device, waiting";
  return text;
}

}  // namespace tegotae::apps
