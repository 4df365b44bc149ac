#include "narrowphase/patch_front.hpp"

#include <algorithm>
#include <cmath>

#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

/// Pairs that wait while one of the front is settled: a fan for each level of both hierarchies, with much to spare.
constexpr std::size_t kDeepest = 4096;
/// Tries to raise, and splits undone, between two looks at the clock; pairs of the wide check.
constexpr int kRaiseStride = 16, kRollBackStride = 64;
constexpr std::uint32_t kChunk = 1024;
/// Failures whose memory is asked for ahead: the next one is asked about with this one.
constexpr std::size_t kFailuresAhead = 3;
/// More splits than this are undone when the motion turns out to be blocked.
constexpr std::size_t kKeepSplits = 512;

/// A tick raises half as many pairs again as it split (or the front grows without end) and this many more; what it
/// cannot raise is owed, up to a bound, and made up by as many more a tick.
constexpr int kRaiseAlways = 2, kMaxDebt = 4096, kMaxRaises = 6;
/// This part of an old debt is paid in one call; a front that is full owes this part of its pairs.
constexpr int kDebtShare = 64, kFullShare = 4;
/// Tries to raise in one call: fewer than the least share come off, and the next call tries half as many; more than the
/// good share, twice as many. Never less than the fewest, and one for so many pairs.
constexpr int kMinTries = 8, kPairsPerTry = 256, kMaxTries = 256, kPoorShare = 8, kGoodShare = 3;
/// The same of parts that slide along each other about a common axis: their fronts grow larger, and what cannot be
/// raised waits, so that tries go where something has changed. On parts that roll over each other it gains nothing.
constexpr int kSlidingRaises = 24, kSlidingTries = 768;
/// Pairs looked at in one call then, and this part of the front; their memory is asked for so many ahead.
constexpr int kMinVisits = 128, kVisitShare = 16;
constexpr std::uint32_t kFetchAhead = 8;
/// A pair that could not be raised waits for so many motions at first, and for so many of its own widths at last.
constexpr double kFirstWait = 4, kLastWait = 4;
/// Tries when time ran out (about 10 µs): without them a front that takes longer than a tick never shrinks. And those
/// of a call that is a long one anyway, because it took so many pairs apart: the next ones make up for them.
constexpr int kLateTries = 32, kManySplits = 1000, kBusyTries = 128;
/// Share of the motion's length that a raised pair must have to spare, or the next motion splits it again; the longest
/// motion of late counts, since a blocked part stands still between two pushes. Not more than this (m), under the gap
/// that motions leave: a part that is pressed to that gap could raise nothing at all.
constexpr double kRaiseSpare = 0.02, kMotionFades = 0.9, kMaxSpare = 3e-7;

}  // namespace

PatchFront::PatchFront(const FrontCapacity& capacity)
    : capacity_(capacity),
      // Every pair of a fan is in the front, so a tree of splits has less than twice as many pairs as the front; odd
      // fans leave unused places, which the factor allows for.
      pool_(4 * std::size_t{capacity.pairs} + kFan),
      groups_{Group(capacity.pairs, kBoxFields), Group(capacity.pairs, kTriFields),
              Group(capacity.curved > 0 ? capacity.pairs : 0, kBoxFields),
              Group(capacity.curved > 0 ? capacity.pairs : 0, kTriFields)},
      curved_(capacity.curved, capacity.curved > 0 ? kMaxAxisPairs : 0),
      failures_(capacity.pairs) {
  stack_.reserve(kDeepest);
  splits_.reserve(capacity.pairs);
  blocking_.reserve(capacity.blocking);
}

void PatchFront::attach(const PatchTree& a, const Vec3& center_A, const PatchTree& b,
                        const std::vector<AxisPair>* axes) noexcept {
  a_ = &a;
  b_ = &b;
  center_ = center_A;
  offset_a_ = a.origin() - center_A;
  for (Group& g : groups_) g.count = 0;
  curved_.attach(axes);
  blocking_.clear();
  splits_.clear();
  pool_used_ = 1;
  free_twos_ = free_fans_ = kNoPair;
  cursor_ = slice_ = 0;
  debt_ = 0;
  asked_to_bend_ = bent_ = passed_over_ = 0;
  sizes_ = {node_reach(a.nodes()[0]), a.radius() + offset_a_.norm(),
            reach_from(b.nodes()[0].center_vec(), b.nodes()[0]), b.radius()};
  slides_ = axes != nullptr && !axes->empty() && capacity_.curved > 0;
  screws_ =
      slides_ && std::any_of(axes->begin(), axes->end(), [](const AxisPair& p) { return p.b->frame().rise != 0; });
  effort_ = slides_ ? kSlidingTries : kMaxTries;
  motion_ = travel_ = 0;
  pool_[0] = {0, 0, kNoPair, kNoPair, 0, 0, 0, false, false, false, false, {0, 0, 0}, 0, 0};
  enter(0);
}

CertifyReport PatchFront::certify(const Pose& X_BA, const Displacement& d, const WorkLimit& limit) noexcept {
  report_ = {};
  limit_ = limit;
  blocking_.clear();
  splits_.clear();
  set_sweep(X_BA, d);
  const double carried = d.dp.norm() + sizes_.reach_a * d.dr.norm();
  if (carried > 0) motion_ = std::max(kMotionFades * motion_, carried);
  travel_ += carried;
  report_.exhausted = !collect_failures();
  const auto failure = [this](std::size_t i) {
    Unsettled u;
    if (i < failure_count_) u.id = failures_[i];
    return u;
  };
  Unsettled next = failure(0);
  for (std::size_t i = 0; i < failure_count_ && !report_.exhausted; ++i) {
    const Unsettled top = next;
    next = failure(i + 1);
    if (i + kFailuresAhead < failure_count_) __builtin_prefetch(&pool_[failures_[i + kFailuresAhead]]);
    const Outcome outcome = settle(top, next);
    if (outcome == Outcome::out_of_work) {
      report_.exhausted = true;
    } else if (outcome == Outcome::blocked && blocking_.size() >= limit_.blocking) {
      break;
    } else if (outcome == Outcome::blocked && blocking_.size() == capacity_.blocking) {
      report_.overflow = true;
      break;
    }
  }
  report_.splits = static_cast<int>(splits_.size());
  if (!blocking_.empty()) {
    report_.status = CertifyStatus::blocked;
    if (splits_.size() > kKeepSplits) roll_back();
  } else if (report_.exhausted) {
    report_.status = CertifyStatus::out_of_budget;
  } else {
    look_ahead(X_BA, d);
  }
  debt_ = std::min(debt_ + report_.splits + report_.splits / 2 + kRaiseAlways, kMaxDebt);
  // Also after a motion that was not certified: its splits stay, and a front that is full of them certifies nothing.
  if (report_.status == CertifyStatus::out_of_budget && report_.overflow) debt_ = std::max(debt_, pairs() / kFullShare);
  raise();
  report_.pairs = pairs();
  report_.share = report_.status == CertifyStatus::certified ? 1 : 0;
  return report_;
}

void PatchFront::set_sweep(const Pose& X_BA, const Displacement& d) {
  sweep_ = Sweep(X_BA, d, center_, *b_, sizes_.radius_a, clearance_);
  beside_ = {Vec3::Zero(), Vec3::Zero()};
  curved_.begin(*a_, center_, *b_, sweep_);
}

bool PatchFront::collect_failures() {
  const bool any_on_a = groups_[kBoxesOnA].count + groups_[kFacesOnA].count > 0;
  const std::array<LaneSweep, 2> seen = {seen_from_b(sweep_, sizes_),
                                         any_on_a ? seen_from_a(sweep_, sizes_) : LaneSweep{}};
  failure_count_ = 0;
  // The nearest first.
  for (const GroupKind kind : {kFacesOnB, kFacesOnA, kBoxesOnB, kBoxesOnA}) {
    const LaneSweep& sweep = seen[kind == kFacesOnA || kind == kBoxesOnA ? 1 : 0];
    for (std::uint32_t first = 0; first < groups_[kind].count; first += kChunk) {
      if (past(limit_.deadline_ns)) return false;
      collect(kind, first, first + kChunk, sweep);
    }
  }
  if (past(limit_.deadline_ns)) return false;
  failure_count_ += curved_.collect_failures(failures_.data() + failure_count_);
  return true;
}

/// Adds those that may fail of a group's slots from `first`, the first of a block, up to `end`.
void PatchFront::collect(GroupKind kind, std::uint32_t first, std::uint32_t end, const LaneSweep& sweep) {
  const Group& g = groups_[kind];
  if (first >= g.count) return;
  const auto check = kind == kFacesOnB || kind == kFacesOnA ? triangle_failures : box_failures;
  std::uint32_t* failed = failures_.data() + failure_count_;
  const std::size_t n = check(g.lanes, first, std::min(g.count, end), sweep, failed);
  for (std::size_t i = 0; i < n; ++i) failed[i] = g.owner[failed[i]];
  failure_count_ += n;
}

void PatchFront::roll_back() {
  // The last first: what is left when time runs out is a front as well, only larger.
  for (int n = 1; !splits_.empty(); ++n) {
    collapse(splits_.back());
    splits_.pop_back();
    if (n % kRollBackStride == 0 && past(limit_.deadline_ns)) break;
  }
}

void PatchFront::raise() {
  const int raises = slides_ ? kSlidingRaises : kMaxRaises;
  const int wanted = std::min(debt_, raises + std::max(report_.splits + report_.splits / 2, debt_ / kDebtShare));
  const int fewest = std::max(kMinTries, pairs() / kPairsPerTry);
  effort_ = std::max(effort_, fewest);
  int at_most = effort_;
  if (report_.splits > kManySplits) at_most = std::min(at_most, kBusyTries);
  if (report_.exhausted) at_most = std::min(at_most, kLateTries);
  const int most = std::min(2 * wanted, at_most);
  int tries = 0;
  auto count = static_cast<std::uint32_t>(pairs());
  // Round robin over all groups, once around at most.
  for (int visits = std::min(pairs(), std::max(kMinVisits, pairs() / kVisitShare));
       visits > 0 && report_.merges < wanted && tries < most; --visits) {
    if (++cursor_ >= count) cursor_ = 0;
    fetch_ahead(count);
    const std::uint32_t id = in_front(cursor_);
    const std::uint32_t parent = pool_[id].parent;
    if (parent == kNoPair || pool_[parent].child != id || !may_raise(parent)) continue;
    if (++tries % kRaiseStride == 0 && !report_.exhausted && past(limit_.deadline_ns)) break;
    if (!try_raise(parent)) continue;
    ++report_.merges;
    count = static_cast<std::uint32_t>(pairs());
  }
  if (kPoorShare * report_.merges < tries) effort_ /= 2;
  if (kGoodShare * report_.merges > tries) effort_ = std::min(2 * effort_, slides_ ? kSlidingTries : kMaxTries);
  debt_ -= report_.merges;
}

/// Pairs and their parents are spread over megabytes, and most are only looked at in passing.
void PatchFront::fetch_ahead(std::uint32_t count) const {
  if (cursor_ + 2 * kFetchAhead >= count) return;
  __builtin_prefetch(&pool_[in_front(cursor_ + 2 * kFetchAhead)]);
  const std::uint32_t parent = pool_[in_front(cursor_ + kFetchAhead)].parent;
  if (parent != kNoPair) __builtin_prefetch(&pool_[parent]);
}

bool PatchFront::may_raise(std::uint32_t id) const {
  return pool_[id].retry <= travel_ && all_in_front(id);
}

/// What could not be raised is tried again when the motion has changed it, at ever longer intervals.
void PatchFront::put_off(std::uint32_t id) {
  if (!slides_) return;
  PairNode& p = pool_[id];
  PatchNode scratch_a, scratch_b;
  const double width = std::min(box_a(p, scratch_a).half[1], box_b(p, scratch_b).half[1]);
  const double first = kFirstWait * motion_, last = std::max(first, kLastWait * width);
  p.wait = static_cast<float>(std::clamp(2.0 * p.wait, first, last));
  p.retry = travel_ + p.wait;
}

bool PatchFront::try_raise(std::uint32_t id) {
  const PairNode& p = pool_[id];
  PatchNode scratch_a, scratch_b;
  const PatchNode &a = box_a(p, scratch_a), &b = box_b(p, scratch_b);
  const Vec3 center = node_center(a);
  // With some gap to spare, or the next motion splits it again.
  const double spare = std::min(kRaiseSpare * motion_, kMaxSpare);
  BoxPair pair{a, b, center, reach_from(center, a), moving(plane(p.child))};
  separate_boxes(pair, pair, sweep_, spare, worth_of_a());
  if (pair.apart) {
    collapse(id);
    set_plane(id, last(pair.plane));
    return true;
  }
  if (bend(id, spare)) return true;
  put_off(id);
  return false;
}

}  // namespace tegotae
