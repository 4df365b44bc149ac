#include "shared/blocker_watch.hpp"

namespace tegotae::apps {
namespace {

constexpr std::size_t kTicks = 1024;  // twice those of the time that is looked back over

}  // namespace

BlockerWatch::BlockerWatch() : ticks_(kTicks) {}

void BlockerWatch::after_tick(const TickView& tick) noexcept {
  if (count_ == ticks_.size()) {
    first_ = (first_ + 1) % ticks_.size();
    --count_;
  }
  ticks_[(first_ + count_) % ticks_.size()] = {tick.t, tick.pen.state.pose, tick.loop.report().proxy.X};
  ++count_;
}

Blocker BlockerWatch::find(const Scene& scene, const InitialContactReport& start, const std::atomic<bool>* stop) const {
  std::vector<TickPoses> last;
  for (std::size_t i = 0; i < count_; ++i) last.push_back(ticks_[(first_ + i) % ticks_.size()]);
  return find_blocker(scene, start, last, stop);
}

}  // namespace tegotae::apps
