#pragma once

#include <algorithm>
#include <cstdint>

#include "core/deadline.hpp"

namespace tegotae {

/// How much of a tick's budget is left for what comes after its deadline: the work between two looks at the clock, the
/// forces, the lists of contacts. Learned from the last ticks that ran out of time, so that those to come end about
/// when the budget does, on fast machines and slow ones. In no tick's way where no deadline bounds it.
class TickReserve {
 public:
  /// When the work of a tick has to stop that is to be over `budget` (s) after `now_ns`.
  std::int64_t stop_after(std::int64_t now_ns, double budget) const noexcept {
    return deadline_after(now_ns, budget - std::min(reserve_, kMost * budget));
  }

  /// A tick of that budget that had to stop at `stop_ns` was over at `end_ns`.
  void ended(std::int64_t stop_ns, std::int64_t end_ns, double budget) noexcept {
    if (stop_ns == kNoDeadline || end_ns < stop_ns) return;
    reserve_ = std::max(kFades * reserve_, std::min(1e-9 * static_cast<double>(end_ns - stop_ns), kMost * budget));
  }

 private:
  /// Of a budget at most this share; by the factor, what is kept fades with every late tick that needs less.
  static constexpr double kMost = 0.3, kFades = 0.95;

  double reserve_ = 0;  // s
};

}  // namespace tegotae
