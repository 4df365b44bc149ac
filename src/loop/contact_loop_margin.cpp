// The gap that contacts keep.
#include <algorithm>

#include "loop/contact_loop.hpp"
#include "loop/contact_margin.hpp"

namespace tegotae {
namespace {

// Every so many ticks the loop tests whether the fit has clearance for a wider margin; the margin grows by this factor
// where it has.
constexpr int kAdaptTicks = 8;
constexpr double kMarginGrowth = 1.1;
// Normals with less than this dot product are of opposite sides, looked for among about so many constraints.
constexpr double kOpposite = -0.3;
constexpr std::size_t kMaxWedging = 64;

}  // namespace

void ContactLoop::adapt_margin(const Pose& Y) {
  // A wide margin makes certificates cheap, but in a fit without clearance for it the part sticks. There is clearance
  // when a motion exists that leaves twice the margin everywhere. Out of a hole such a motion always exists, so a part
  // that is wedged between opposite sides counts as without. The margin never grows under a part at rest, which it
  // would push around.
  const auto& constraints = at_.contacts->constraints();
  if (min_margin_ == max_margin_ || constraints.empty() || ++ticks_ % kAdaptTicks != 0) return;
  const bool standing = moved_ < kStanding;
  const bool holds = standing && size(displacement(X_, Y, center_)) > max_margin_ && wedged();
  // Gaps a little below the smallest margin may lock a part that could turn out of where it stands.
  recover_below_ = holds && margin_ == min_margin_ ? kRecoverWedged : kRecoverBelow;
  if (holds) {
    margin_ = std::max(0.5 * margin_, min_margin_);
    return;
  }
  metric_.set_orientation(X_.q);
  rows_.clear();
  for (const Contact& c : constraints) {
    if (c.age == kOneShotAge) continue;  // planes for one motion, not surfaces
    bounds_[static_cast<std::size_t>(rows_.rows())] = 2 * margin_ - c.gap;
    rows_.push_row(metric_.row(c));
  }
  const bool room = resolver_->resolve(rows_, bounds_.data(), Vec6::Zero()).status != ResolveStatus::infeasible;
  if (!room) margin_ = std::max(0.5 * margin_, min_margin_);
  if (room && !standing) margin_ = std::min(kMarginGrowth * margin_, max_margin_);
}

bool ContactLoop::wedged() const {
  const auto& constraints = at_.contacts->constraints();
  // Of many constraints an even sample: neighbors in the list are of one side.
  const std::size_t stride = constraints.size() / kMaxWedging + 1;
  const auto presses = [this](const Contact& c) { return c.age != kOneShotAge && c.gap <= margin_ / kMarginShare; };
  for (std::size_t i = 0; i < constraints.size(); i += stride)
    for (std::size_t j = 0; j < i && presses(constraints[i]); j += stride)
      if (presses(constraints[j]) && constraints[i].n.dot(constraints[j].n) < kOpposite) return true;
  return false;
}

}  // namespace tegotae
