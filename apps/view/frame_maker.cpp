#include "view/frame_maker.hpp"

#include <limits>

namespace tegotae::view {

void FrameMaker::add_loop(const HapticLoop& loop, Frame& frame) const {
  const TickReport& report = loop.report();
  const auto& limits = loop.constraints();
  store(report.proxy.X, frame.x);
  frame.contacts = static_cast<std::uint32_t>(report.contacts);
  frame.limits = static_cast<std::uint32_t>(limits.size());
  frame.gap = report.gap;
  frame.flags = (report.proxy.touching ? Frame::touching : 0u) | (report.flags.timed_out ? Frame::cut : 0u) |
                (report.flags.overflow ? Frame::overflow : 0u) |
                static_cast<std::uint32_t>(report.lag_reason) << Frame::kLagShift;
  store(report.forces, frame);
  frame.pair_count = 0;
  const Vec3 center = report.proxy.X * loop.center();
  for (const bool touching : {true, false})
    for (const Contact& c : limits) {
      if ((c.age != kOneShotAge && c.gap <= report.contact_gap) != touching) continue;
      if (frame.pair_count == kMaxPairs) return;
      FramePair& p = frame.pairs[frame.pair_count++];
      for (int i = 0; i < 3; ++i) {
        p.point[i] = center[i] + c.r[i];
        p.normal[i] = c.n[i];
      }
      p.gap = c.gap;
      p.part = numbers_.empty() ? c.part.index : numbers_[c.part.index];
      p.touching = touching ? 1 : 0;
      p.features = static_cast<std::uint32_t>(c.feature_a.kind) + 3 * static_cast<std::uint32_t>(c.feature_b.kind);
    }
}

/// A reason that lasts one servo tick can fall between two ticks of this loop, for instance when both were delayed: the
/// servo's counter shows it.
void FrameMaker::look_for_reason(const TickView& tick) {
  if (tick.pen.reason == ForceOff::none) force_off_ = tick.servo.force_off;
  if (tick.pen.reason != ForceOff::engage) {
    reason_ = tick.pen.reason;
    return;
  }
  for (std::size_t i = 0; reason_ == ForceOff::none && i < force_off_.size(); ++i)
    if (static_cast<ForceOff>(i) != ForceOff::engage && tick.servo.force_off[i] > force_off_[i])
      reason_ = static_cast<ForceOff>(i);
}

void FrameMaker::fill(const TickView& tick, Frame& frame) {
  look_for_reason(tick);
  add_loop(tick.loop, frame);
  frame.tick = tick.tick;
  frame.t = tick.t;
  store(tick.pen.state.pose, frame.y);
  store(tick.pen.wrench, frame.wrench);
  frame.tick_us = tick.tick_us;
  frame.servo_late_us = tick.servo_late_us.value_or(std::numeric_limits<double>::quiet_NaN());
  if (tick.pen.status == DeviceStatus::enabled) frame.flags |= Frame::force_on;
  if (tick.pen.reason == ForceOff::engage) frame.flags |= Frame::waiting;
  frame.reason = static_cast<std::uint32_t>(reason_);
}

}  // namespace tegotae::view
