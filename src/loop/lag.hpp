#pragma once

#include <algorithm>
#include <cstdint>

#include "tegotae/loop/haptic_loop.hpp"

namespace tegotae {

/// What a tick of a loop that never penetrates knows at its end of what holds the part back.
struct TickEnd {
  double lag = 0;                 ///< |X − Y| as TickReport::lag, m
  double bound = 0;               ///< lag_bound() of the part, m
  int contacts = 0;               ///< TickReport::contacts
  bool held_by_contacts = false;  ///< the last program over all constraints allowed no motion worth making
  double allowed = 0;             ///< length of the motion that it allowed and that was not made, m
  bool late = false;              ///< the tick's time is over
  bool moved = false;             ///< X moved in this tick
};

/// Contacts explain a lag only when they stand in its way: a part that lies on a floor and lags along it is late, not
/// in contact.
inline LagReason lag_reason(const TickEnd& end) {
  constexpr double kArrived = 1e-8;      // m
  constexpr double kAllowedShare = 0.5;  // of the lag: more of it would go away if only the motion were made
  if (end.lag <= kArrived) return LagReason::none;
  const bool little_allowed = end.allowed <= std::min(end.bound, kAllowedShare * end.lag);
  if (end.contacts > 0 && (end.held_by_contacts || little_allowed)) return LagReason::contact;
  return end.late || end.moved ? LagReason::time : LagReason::capacity;
}

/// Whether a part lags, over the bound, for another reason than contact: where it is then is not where it came to rest.
inline bool held_up(double lag, double bound, LagReason reason) {
  return lag > bound && reason != LagReason::none && reason != LagReason::contact;
}

/// Counts TickReport::unexplained_lag_ticks.
class LagCounter {
 public:
  /// After each tick, in which the part came `moved` (m). A part on its way is not held back: a pen that jumps is far
  /// ahead of it for a while.
  void add(double lag, double moved, double bound, LagReason reason) noexcept {
    const bool explained = lag <= bound || moved > bound || reason == LagReason::none || reason == LagReason::contact;
    row_ = explained ? 0 : std::min(row_ + 1, kLagPatience + 1);
    if (row_ > kLagPatience) ++ticks_;
  }
  std::int64_t ticks() const noexcept { return ticks_; }

 private:
  int row_ = 0;
  std::int64_t ticks_ = 0;
};

}  // namespace tegotae
