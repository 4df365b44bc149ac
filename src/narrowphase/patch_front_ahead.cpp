// What a PatchFront does before it must, so that a thread's bursts are spread over the ticks before them: the facets of
// a nut and its bolt fall into step in all turns of the thread at once.
#include <algorithm>

#include "narrowphase/patch_front.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

/// Fronts of fewer pairs have no burst that takes a tick.
constexpr int kLargeFront = 1 << 13;
/// The motion goes on as it did for so many times its length; each call looks at one of so many slices of the front.
constexpr double kMotionsAhead = 6;
constexpr std::uint32_t kSlices = 4;
/// A burst is coming when the front has so many pairs that will fail: hundreds always do, and most find another plane
/// at little cost when their time comes.
constexpr std::size_t kBurst = 1000;
/// What is done about it in a call, and with what the call had to do anyway, in searches (0.3 µs each); nothing after
/// so many splits.
constexpr int kSearchesAhead = 1000, kSearchesInAll = 1600, kBusySplits = 600;

}  // namespace

/// After a certified motion: what would fail soon, if it goes on as it did, gets another plane or comes apart now. What
/// is raised after that holds for the way ahead as well.
void PatchFront::look_ahead(const Pose& X_BA, const Displacement& d) {
  const bool moves = d.dp.squaredNorm() + d.dr.squaredNorm() > 0;
  if (!screws_ || !moves || pairs() < kLargeFront || report_.splits >= kBusySplits) return;
  set_sweep(displaced(X_BA, center_, d), {kMotionsAhead * d.dp, kMotionsAhead * d.dr});
  slice_ = (slice_ + 1) % kSlices;
  failure_count_ = 0;
  const auto collect_slice = [this](GroupKind kind, const LaneSweep& sweep) {
    constexpr std::uint32_t kBlock = kLanes;
    const std::uint32_t blocks = (groups_[kind].count + kBlock - 1) / kBlock;
    collect(kind, kBlock * (blocks * slice_ / kSlices), kBlock * (blocks * (slice_ + 1) / kSlices), sweep);
  };
  collect_slice(kBoxesOnB, seen_from_b(sweep_, sizes_));
  collect_slice(kBoxesOnA, seen_from_a(sweep_, sizes_));
  if (kSlices * failure_count_ < kBurst) return;

  const CertifyReport asked = report_;
  const WorkLimit limit = limit_;
  limit_.searches =
      std::min({limit_.searches, asked.searches + kSearchesAhead, std::max(asked.searches, kSearchesInAll)});
  // What comes after it in this tick has the other half of the time.
  if (limit_.deadline_ns != kNoDeadline) {
    const std::int64_t now = monotonic_ns();
    limit_.deadline_ns = now + (limit_.deadline_ns - now) / 2;
  }
  for (std::size_t i = 0; i < failure_count_; ++i) {
    Unsettled top, none;
    top.id = failures_[i];
    const Outcome outcome = settle(top, none);
    blocking_.clear();  // nothing is said of what may never be
    if (outcome == Outcome::out_of_work) break;
  }
  limit_ = limit;
  report_.splits = static_cast<int>(splits_.size());
  report_.exhausted = asked.exhausted;
  report_.overflow = asked.overflow;
}

}  // namespace tegotae
