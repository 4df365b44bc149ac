#include "loop/scene_changes.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

namespace tegotae {
namespace {

constexpr std::chrono::milliseconds kPoll(1);
constexpr double kLongestWait = 1e6;  // s; far below where a clock overflows

}  // namespace

SceneChange::SceneChange(std::shared_ptr<Record> record) : record_(std::move(record)) {}

std::uint64_t SceneChange::number() const noexcept {
  return record_->number;
}
ChangeState SceneChange::state() const noexcept {
  return record_->state.load(std::memory_order_acquire);
}
const InitialContactReport& SceneChange::start() const noexcept {
  return record_->start;
}

ChangeState SceneChange::wait(double seconds) const {
  const double longest = std::isnan(seconds) ? 0 : std::clamp(seconds, 0.0, kLongestWait);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(longest);
  while (state() == ChangeState::pending && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(kPoll);
  return state();
}

bool SceneChange::cancel() {
  const std::shared_ptr<SceneChanges> changes = record_->changes.lock();
  return changes && changes->cancel(*record_);
}

SceneChanges::SceneChanges(const RunningScene& first) {
  known_[0] = {first.obstacles, first.held};
}

SceneChange SceneChanges::offer(const Scene& next,
                                const std::function<void(std::uint64_t, const InitialContactReport&)>& ready) {
  const std::lock_guard<std::mutex> lock(changing_);
  auto changed = std::make_unique<RunningScene>(next);
  changed->warm_up();
  const std::uint64_t now = in_force();
  changed->compare(*obstacles_of(now), now);
  const std::uint64_t number = changed->number = last_ + 1;
  auto record = std::make_shared<SceneChange::Record>(number, changed->loop->start(), weak_from_this());
  if (ready) ready(number, record->start);
  last_ = number;
  {
    const std::lock_guard<std::mutex> reading(reading_);
    known_[number] = {changed->obstacles, changed->held};
  }
  changed->change = record;
  next_.offer(std::move(changed));
  return SceneChange(std::move(record));
}

std::shared_ptr<const std::vector<RunningScene::Obstacle>> SceneChanges::obstacles_of(std::uint64_t number) {
  const std::lock_guard<std::mutex> lock(reading_);
  known_.erase(known_.begin(), known_.find(number));
  return known_.at(number).obstacles;
}

std::string SceneChanges::held() const {
  const std::lock_guard<std::mutex> lock(reading_);
  return known_.at(in_force()).held;
}

bool SceneChanges::cancel(SceneChange::Record& change) {
  const std::lock_guard<std::mutex> lock(changing_);
  while (change.number == last_ && change.state.load(std::memory_order_acquire) == ChangeState::pending) {
    if (const std::unique_ptr<RunningScene> mine = next_.withdraw()) {
      change.state.store(ChangeState::canceled, std::memory_order_release);
      last_ = in_force();
      return true;
    }
    // A tick has taken it: it comes into force, or is put back, within that tick. A thread of a higher priority than
    // the loop's must sleep for that.
    std::this_thread::sleep_for(kPoll);
  }
  return false;
}

void SceneChanges::put_back(RunningScene* changed) noexcept {
  if (next_.put_back(changed)) return;
  changed->change->state.store(ChangeState::replaced, std::memory_order_release);
  next_.retire(changed);
}

void SceneChanges::come_into_force(RunningScene& changed, RunningScene* before) noexcept {
  if (before->change) before->change->state.store(ChangeState::superseded, std::memory_order_release);
  next_.retire(before);
  in_force_.store(changed.number, std::memory_order_release);
  changed.change->state.store(ChangeState::in_force, std::memory_order_release);
}

}  // namespace tegotae
