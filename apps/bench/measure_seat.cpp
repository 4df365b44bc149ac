#include "bench/measure_seat.hpp"

#include <cmath>
#include <limits>

#include "tegotae/core/clock.hpp"

namespace tegotae::bench {
namespace {

constexpr double kSeatPeriod = 1e-3;  // s
// Above its seat by at most this much (m) a part is there: what is kept between parts, and the sagittas of facets.
constexpr double kThere = 60e-6;
// A part that lags by less (m) follows the pen.
constexpr double kFollows = 0.3e-3;
constexpr double kSeatRest = 0.5, kSeatWait = 0.3;  // s: at rest, and before and after the lift
// Of the rest that counts as such: its second half. Of poses, one in as many is kept for the check.
constexpr double kSettled = 0.5;
constexpr std::size_t kStride = 10;
constexpr double kSlideSpeed = 0.05;  // m/s, of the pen

/// When each phase of the pen ends, s.
struct Phases {
  double down, rest, slide, back, settled, up, end;
};

Phases phases(const SeatPen& pen) {
  Phases t{};
  t.down = (pen.above + pen.below) / kHandSpeed.linear;
  t.rest = t.down + kSeatRest;
  t.slide = t.rest + pen.slide.norm() / kSlideSpeed;
  t.back = t.slide + pen.slide.norm() / kSlideSpeed;
  t.settled = t.back + kSeatWait;
  t.up = t.settled + (pen.above + pen.below) / kHandSpeed.linear;
  t.end = t.up + kSeatWait;
  return t;
}

StylusScript script(const SeatPen& pen, const Phases& t) {
  const Vec3 z = Vec3::UnitZ();
  const auto at = [](const Vec3& p) { return Pose{Quat::Identity(), p}; };
  const Vec3 pressed = pen.seat - pen.below * z, aside = pressed + pen.slide;
  return StylusScript({{0, at(pen.seat + pen.above * z)},
                       {t.down, at(pressed)},
                       {t.rest, at(pressed)},
                       {t.slide, at(aside)},
                       {t.back, at(pressed)},
                       {t.settled, at(pressed)},
                       {t.up, at(pen.seat + pen.above * z)},
                       {t.end, at(pen.seat + pen.above * z)}});
}

constexpr double kNever = std::numeric_limits<double>::quiet_NaN();

/// Follows the part through the phases.
class SeatWatch {
 public:
  SeatWatch(const SeatPen& pen, const Phases& phases) : pen_(pen), phases_(phases) {}

  void look(double t, const Pose& Y, const Pose& X) {
    const double y = Y.p.z() - pen_.seat.z(), x = X.p.z() - pen_.seat.z();
    if (t <= phases_.rest) {
      if (y <= 0 && std::isnan(pen_down_)) pen_down_ = t;
      if (y <= 0 && x <= kThere && std::isnan(there_)) there_ = t;
      above_ = x;
      from_ = X.p;
    } else if (t <= phases_.slide) {
      slid_ = (X.p - from_).dot(pen_.slide.normalized());
    } else if (t > phases_.settled) {
      if (y > kThere && std::isnan(pen_up_)) pen_up_ = t;
      const bool follows = (Y.p - X.p).norm() < kFollows;
      if (!follows) off_ = kNever;
      if (follows && std::isnan(off_) && !std::isnan(pen_up_)) off_ = t;
    }
  }
  void tell(SeatFigures& f) const {
    f.arrival_ms = 1e3 * (there_ - pen_down_);
    f.above_seat = above_;
    f.slide_mm_s = 1e3 * slid_ / (phases_.slide - phases_.rest);
    f.off_ms = 1e3 * (off_ - pen_up_);
  }

 private:
  const SeatPen& pen_;
  Phases phases_;
  double pen_down_ = kNever, there_ = kNever, pen_up_ = kNever, off_ = kNever;
  double above_ = kNever, slid_ = kNever;
  Vec3 from_ = Vec3::Zero();
};

}  // namespace

SeatFigures measure_seat(const BenchScene& scene, HapticLoop& loop, LoopTrace& trace) {
  const SeatPen& pen = *scene.seat;
  const Phases t = phases(pen);
  const StylusScript way = script(pen, t);
  SeatFigures f;
  f.ticks = static_cast<std::size_t>(std::ceil(t.end / kSeatPeriod)) + 1;
  std::vector<std::int64_t> rest, moving;
  rest.reserve(f.ticks);
  moving.reserve(f.ticks);
  SeatWatch watch(pen, t);
  on_measuring_thread([&] {
    Rest pause;
    for (std::size_t k = 0; k < f.ticks; ++k) {
      const double now = kSeatPeriod * static_cast<double>(k);
      const Pose Y = way.pose(now);
      pause.pause_if_due();
      const std::int64_t start = monotonic_ns();
      const TickReport& r = loop.step(Y, kSeatPeriod);
      const std::int64_t took = monotonic_ns() - start;
      watch.look(now, Y, r.proxy.X);
      f.cut += r.flags.timed_out;
      if (now > t.rest - kSettled * kSeatRest && now <= t.rest)
        rest.push_back(took);
      else if (r.contacts > 0 || r.flags.timed_out)
        moving.push_back(took);
      if (k % kStride != 0) continue;
      trace.committed.add(r.proxy.X);
      ++trace.checked;
    }
  });
  watch.tell(f);
  f.rest_us = percentiles(rest);
  f.moving_us = percentiles(moving);
  return f;
}

}  // namespace tegotae::bench
