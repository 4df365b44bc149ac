#pragma once

#include <vector>

#include "tegotae/session/session.hpp"
#include "view/frame.hpp"

namespace tegotae::view {

/// Makes frames of a run's ticks, without allocation.
class FrameMaker {
 public:
  FrameMaker() = default;
  /// `numbers`: how frames number the scene's parts, instead of by PartId.
  explicit FrameMaker(std::vector<std::uint32_t> numbers) : numbers_(std::move(numbers)) {}

  /// Fills in what the loop knows: X, contacts, gap, contact forces, pairs. Of more pairs than fit, those in contact
  /// come first.
  void add_loop(const HapticLoop& loop, Frame& frame) const;
  /// All of a running session's tick.
  void fill(const TickView& tick, Frame& frame);

 private:
  void look_for_reason(const TickView& tick);

  std::vector<std::uint32_t> numbers_;                // of the parts
  ForceOff reason_ = ForceOff::none;                  // why the force went off, also while it waits to come on again
  decltype(ServoStatistics::force_off) force_off_{};  // as long as it was on
};

}  // namespace tegotae::view
