#include "session/run_check.hpp"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/deadline.hpp"
#include "core/parallel_for.hpp"
#include "core/same_pose.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae {

namespace {

// Poses on their way: a minute of a contact loop that makes one a tick, while FCL answers one question.
constexpr std::size_t kOnTheWay = 65536;
// Poses in a row that are asked about one after the other.
constexpr std::size_t kBlock = 64;
// Blocks that wait to be asked about; of more, every second, fourth, ... one.
constexpr std::size_t kMaxWaiting = 20000 / kBlock;
constexpr double kIdle = 5e-3;   // s between two looks for poses where there are none
constexpr double kSlice = 5e-3;  // s of questions between two looks for poses; one question may take longer
constexpr int kNice = 10;

}  // namespace

CheckedSegment::CheckedSegment(const Scene& scene, const InitialContactReport& start, bool waits)
    : judged_(scene, start), ring_(kOnTheWay), waits_(waits) {}

void CheckedSegment::add(const Pose& X, std::uint32_t freed) noexcept {
  const bool first = poses_.load(std::memory_order_relaxed) == 0;
  if (!first && same_pose(X, last_)) return;
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
  const std::int64_t deadline_ns = deadline_after(monotonic_ns(), time);
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
  Asker asker;
  for (bool last = false; !last;) {
    last = ended_;  // before the poses are collected: none comes after it
    collect(last);
    if (last) break;
    const std::int64_t begin = monotonic_ns();
    const bool asked = ask_some(asker);
    const double took = 1e-9 * static_cast<double>(monotonic_ns() - begin);
    if (!rest(!asked ? kIdle : real_time_ ? took * (1 / kShare - 1) : 0)) return;
  }
  give_back(asker);
  ask_all();
  done_ = true;
}

bool RunCheck::rest(double seconds) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (seconds > 0)
    wake_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return abandoned_ || ended_; });
  return !abandoned_;
}

void RunCheck::collect(bool last) {
  const std::lock_guard<std::mutex> lock(mutex_);
  CheckedSegment::Item item;
  for (CheckedSegment* s : segments_) {
    const auto own = std::find_if(filling_.begin(), filling_.end(), [s](const Block& b) { return b.segment == s; });
    Block& block = own == filling_.end() ? filling_.emplace_back(Block{s, {}}) : *own;
    while (s->ring_.pop(item)) {
      block.items.push_back(item);
      if (block.items.size() == kBlock) add(std::exchange(block, Block{s, {}}));
    }
    if (last && !block.items.empty()) add(std::exchange(block, Block{s, {}}));
  }
}

void RunCheck::add(Block block) {
  if (seen_++ % stride_ != 0) return;
  const std::lock_guard<std::mutex> lock(queue_mutex_);
  left_ += static_cast<std::int64_t>(block.items.size());
  waiting_.push_back(std::move(block));
  if (!all_ && waiting_.size() == kMaxWaiting) thin_out();
}

void RunCheck::thin_out() {
  // They are in no order, but half of them in any order is a fair half.
  for (std::size_t i = 1; i < waiting_.size(); i += 2) left_ -= static_cast<std::int64_t>(waiting_[i].items.size());
  for (std::size_t i = 0; 2 * i < waiting_.size(); ++i) std::swap(waiting_[i], waiting_[2 * i]);
  waiting_.resize((waiting_.size() + 1) / 2);
  stride_ *= 2;
}

/// Asks for a slice of time, of one block; false when no pose waits.
bool RunCheck::ask_some(Asker& asker) {
  if (asker.next == asker.block.items.size() && !take_block(asker)) return false;
  const std::int64_t until_ns = deadline_after(monotonic_ns(), kSlice);
  while (asker.next < asker.block.items.size() && monotonic_ns() < until_ns) {
    const CheckedSegment::Item& item = asker.block.items[asker.next++];
    const bool hit = asker.judge->intersects(item.X, item.freed, &abandoned_);
    if (!hit && abandoned_) return true;  // maybe broken off
    if (hit) ++intersecting_;
    ++checked_;
    --left_;
  }
  return true;
}

bool RunCheck::take_block(Asker& asker) {
  {
    const std::lock_guard<std::mutex> lock(queue_mutex_);
    if (waiting_.empty()) return false;
    // At random, so that what is asked by the end is spread over the whole run.
    std::swap(waiting_[rng_() % waiting_.size()], waiting_.back());
    asker.block = std::move(waiting_.back());
    waiting_.pop_back();
  }
  asker.next = 0;
  if (asker.segment != asker.block.segment) {
    asker.segment = asker.block.segment;
    asker.judge.emplace(asker.block.segment->judged_);
  }
  return true;
}

/// Lets others ask about the rest of the block.
void RunCheck::give_back(Asker& asker) {
  const auto asked = asker.block.items.begin() + static_cast<std::ptrdiff_t>(asker.next);
  asker.block.items.erase(asker.block.items.begin(), asked);
  asker.next = 0;
  const std::lock_guard<std::mutex> lock(queue_mutex_);
  if (!asker.block.items.empty()) waiting_.push_back(std::exchange(asker.block, Block{nullptr, {}}));
}

/// Asks about what waits, on all processors.
void RunCheck::ask_all() {
  const auto ask = [this](int) {
    Asker asker;
    while (!abandoned_ && ask_some(asker)) {
    }
  };
  const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  parallel_for(threads, threads, ask, {});
}

}  // namespace tegotae
