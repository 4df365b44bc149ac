#include "session/run_check.hpp"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>

#include "tegotae/core/clock.hpp"

namespace tegotae {

namespace {

// Poses on their way: a minute of a contact loop that makes one a tick, while FCL answers one question.
constexpr std::size_t kOnTheWay = 65536;
// Poses that wait to be asked about; of more, every second, fourth, ... one.
constexpr std::size_t kMaxWaiting = 20000;
constexpr double kIdle = 5e-3;  // s between two looks for poses where there are none
constexpr int kNice = 10;

}  // namespace

CheckedSegment::CheckedSegment(const Scene& scene, const InitialContactReport& start, bool waits)
    : judge_(scene, start), ring_(kOnTheWay), waits_(waits) {}

void CheckedSegment::add(const Pose& X, std::uint32_t freed) noexcept {
  const bool first = poses_.load(std::memory_order_relaxed) == 0;
  if (!first && X.p == last_.p && X.q.coeffs() == last_.q.coeffs()) return;
  last_ = X;
  poses_.fetch_add(1, std::memory_order_relaxed);
  while (!ring_.push({X, freed}) && waits_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

RunCheck::RunCheck(bool all, bool real_time) : all_(all), real_time_(real_time) {
  thread_ = std::thread([this] { work(); });
}

RunCheck::~RunCheck() {
  abandon();
}

void RunCheck::abandon() noexcept {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    abandoned_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

std::unique_ptr<CheckedSegment> RunCheck::segment(const Scene& scene, const InitialContactReport& start) {
  return std::make_unique<CheckedSegment>(scene, start, !real_time_);
}

void RunCheck::watch(CheckedSegment& segment) {
  const std::lock_guard<std::mutex> lock(mutex_);
  segments_.push_back(&segment);
}

std::int64_t RunCheck::poses() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::int64_t count = 0;
  for (const CheckedSegment* s : segments_) count += s->poses_.load(std::memory_order_relaxed);
  return count;
}

void RunCheck::end(double seconds, const std::atomic<bool>* stop, std::atomic<double>* share) {
  const double time = std::max(kMinTime, kShare * seconds);
  const std::int64_t deadline_ns = monotonic_ns() + static_cast<std::int64_t>(1e9 * time);
  ended_ = true;
  wake_.notify_one();
  const auto over = [&] {
    return (stop != nullptr && stop->load(std::memory_order_relaxed)) || (!all_ && monotonic_ns() > deadline_ns);
  };
  const std::int64_t before = checked_;
  while (!done_ && !over()) {
    const auto asked = static_cast<double>(checked_ - before);
    if (share != nullptr) share->store(asked / std::max(1.0, asked + static_cast<double>(left_)));
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  abandon();
}

void RunCheck::work() {
  // Threads of Linux have priorities of their own. Where it is refused the quarter still holds.
  setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNice);
  for (;;) {
    const bool last = ended_;  // before the poses are collected: none comes after it
    collect();
    left_ = static_cast<std::int64_t>(waiting_.size());
    if (waiting_.empty() && last) break;
    const std::int64_t begin = monotonic_ns();
    if (!waiting_.empty()) ask();
    const double took = 1e-9 * static_cast<double>(monotonic_ns() - begin);
    const bool hold_back = real_time_ && !last;
    if (!rest(waiting_.empty() ? kIdle : hold_back ? took * (1 / kShare - 1) : 0)) break;
  }
  done_ = true;
}

bool RunCheck::rest(double seconds) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (seconds > 0)
    wake_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return abandoned_ || ended_; });
  return !abandoned_;
}

void RunCheck::collect() {
  const std::lock_guard<std::mutex> lock(mutex_);
  CheckedSegment::Item item;
  for (CheckedSegment* s : segments_)
    while (s->ring_.pop(item)) {
      if (seen_++ % stride_ != 0) continue;
      waiting_.push_back({s, item});
      if (!all_ && waiting_.size() == kMaxWaiting) thin_out();
    }
}

void RunCheck::thin_out() {
  // They are in no order, but half of them in any order is a fair half.
  for (std::size_t i = 0; 2 * i < waiting_.size(); ++i) waiting_[i] = waiting_[2 * i];
  waiting_.resize(waiting_.size() / 2);
  stride_ *= 2;
}

void RunCheck::ask() {
  // At random, so that what is asked by the end is spread over the whole run.
  std::swap(waiting_[rng_() % waiting_.size()], waiting_.back());
  const Waiting w = waiting_.back();
  waiting_.pop_back();
  if (w.segment->judge_.intersects(w.item.X, w.item.freed)) ++intersecting_;
  ++checked_;
}

}  // namespace tegotae
