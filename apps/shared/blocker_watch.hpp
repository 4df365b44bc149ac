#pragma once

#include <vector>

#include "shared/blocker.hpp"
#include "tegotae/session/session.hpp"

namespace tegotae::apps {

/// Remembers the last poses of a run whose scene stays, to tell who was in the way at its end.
class BlockerWatch final : public RunObserver {
 public:
  BlockerWatch();
  void before_tick(double) override {}
  void after_tick(const TickView& tick) noexcept override;

  /// find_blocker() at the end of the run. `scene`: of the run; `start`: RunSummary::start.
  Blocker find(const Scene& scene, const InitialContactReport& start, const std::atomic<bool>* stop = nullptr) const;

 private:
  std::vector<TickPoses> ticks_;  // a ring: of more, the oldest go
  std::size_t first_ = 0, count_ = 0;
};

}  // namespace tegotae::apps
