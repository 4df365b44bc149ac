// A hand that goes where the pen goes, and what a run made of it.
#pragma once

#include <cstdint>
#include <vector>

#include "tegotae/session/session.hpp"

namespace tegotae::test {

/// Holds the pen and wants nothing: its grip damps, and follows wherever the pen goes.
class LooseHand final : public InputSource {
 public:
  explicit LooseHand(const Pose& start) : start_(start) {}
  double begin() const noexcept override { return 0; }
  Pose start() const noexcept override { return start_; }
  HandTarget target(double, const Pose& pen) noexcept override { return {pen, {}}; }

 private:
  Pose start_;
};

/// Keeps what each tick had.
class Ticks final : public RunObserver {
 public:
  void before_tick(double) override {}
  void after_tick(const TickView& tick) noexcept override {
    wrench.push_back(tick.pen.wrench);
    X.push_back(tick.loop.report().proxy.X);
    flags |= tick.pen.flags;
    off += tick.pen.reason != ForceOff::none && tick.t > 0.1 ? 1 : 0;
  }
  std::vector<Wrench> wrench;
  std::vector<Pose> X;
  std::uint32_t flags = 0;
  int off = 0;  // ticks without force, after the first ones
};

}  // namespace tegotae::test
