// The gap that contacts keep.
#include <algorithm>

#include "loop/contact_loop.hpp"
#include "loop/kept_gap.hpp"

namespace tegotae {
namespace {

// Between the gap kept in the closest fits and l_min the room is looked at every so many ticks; the gap grows by this
// factor where there is room for more.
constexpr int kAdaptTicks = 8;
constexpr double kKeepGrowth = 1.1;
// Normals with less than this dot product are of opposite sides, looked for among about so many limits.
constexpr double kOpposite = -0.3;
constexpr std::size_t kMaxWedging = 64;

}  // namespace

void ContactLoop::adapt_keep(const Pose& Y) {
  // A wide gap makes certificates cheap, but in a fit that has no room for it the part sticks. There is room for a gap
  // when a motion exists that leaves twice as much everywhere; out of a hole there always is one, so a part that stands
  // wedged between opposite sides has none either. The gap never grows under a part at rest: it would push it about.
  const auto& limits = at_.contacts->limits();
  if (least_keep_ == most_keep_ || limits.empty() || ++ticks_ % kAdaptTicks != 0) return;
  const bool standing = moved_ < kStanding;
  const bool holds = standing && size(displacement(X_, Y, center_)) > most_keep_ && wedged();
  // Gaps that are a little short of the least one may lock a part that has room to turn out of where it stands.
  recover_below_ = holds && keep_ == least_keep_ ? kRecoverWedged : kRecoverBelow;
  if (holds) {
    keep_ = std::max(0.5 * keep_, least_keep_);
    return;
  }
  metric_.set_orientation(X_.q);
  rows_.clear();
  for (const Contact& c : limits) {
    if (c.age == kOneShotAge) continue;  // planes for one motion, not surfaces
    bounds_[static_cast<std::size_t>(rows_.rows())] = 2 * keep_ - c.gap;
    rows_.push_row(metric_.row(c));
  }
  const bool room = resolver_->resolve(rows_, bounds_.data(), Vec6::Zero()).status != ResolveStatus::infeasible;
  if (!room) keep_ = std::max(0.5 * keep_, least_keep_);
  if (room && !standing) keep_ = std::min(kKeepGrowth * keep_, most_keep_);
}

bool ContactLoop::wedged() const {
  const auto& limits = at_.contacts->limits();
  // Of many limits an even sample: neighbors in the list are of one side.
  const std::size_t stride = limits.size() / kMaxWedging + 1;
  const auto presses = [this](const Contact& c) { return c.age != kOneShotAge && c.gap <= keep_ / kKeepShare; };
  for (std::size_t i = 0; i < limits.size(); i += stride)
    for (std::size_t j = 0; j < i && presses(limits[i]); j += stride)
      if (presses(limits[j]) && limits[i].n.dot(limits[j].n) < kOpposite) return true;
  return false;
}

}  // namespace tegotae
