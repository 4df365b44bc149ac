#pragma once

#include <string>
#include <vector>

#include "tegotae/session/session.hpp"

namespace tegotae::apps {

/// The part that was in the way at the end of a run.
struct Blocker {
  std::string part;             ///< its name; empty: none was
  Vec3 place_W = Vec3::Zero();  ///< middle of the last contacts with it, m
};

/// Remembers with which parts the held one was in contact lately, in a run whose scene stays.
class BlockerWatch final : public RunObserver {
 public:
  BlockerWatch();
  void before_tick(double) override {}
  void after_tick(const TickView& tick) noexcept override;

  /// The part that was in contact in most ticks of the last half second. `scene`: of the run.
  Blocker find(const Scene& scene) const;

 private:
  struct Touch {
    double t;
    PartId part;
    Vec3 place_W;
  };
  const Touch& touch(std::size_t i) const { return touches_[(first_ + i) % touches_.size()]; }
  void add(const Touch& touch) noexcept;

  std::vector<Touch> touches_;  // a ring: of more, the oldest go
  std::size_t first_ = 0, count_ = 0;
  double end_ = 0;  // s, of the newest tick
};

}  // namespace tegotae::apps
