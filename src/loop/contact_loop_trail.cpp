// What a part does whose way to the pen is not proved in time: it follows the way by which it came.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/same_pose.hpp"
#include "loop/contact_loop.hpp"

namespace tegotae {
namespace {

// A part whose way is not proved in time goes along its trail to where it touched something, if that is no farther from
// the pen on the way, or to where less than this share of the squared distance to it is left.
constexpr double kNearerOnTrail = 0.8;
// If the trail leads away from the pen first, for no more than so many times the straight way.
constexpr double kDetour = 1.5;
// The pen comes back to a place where the cosine between its motion and the way there is larger.
constexpr double kComesBack = 0.5;
// Where the pen does not come back to what was touched, ways to it are looked at in a few ticks. A look begins anew
// wherever the part goes, and has the first of so many ticks: more of them each time, or it would never come to an end.
constexpr int kPatience = 4, kTicksOfLooks = 16;
// Where more than this share of a look is done, the part waits for the rest, for so many ticks.
constexpr double kMostIsThere = 0.5;
constexpr int kWaitsForRest = 2;
// A way across to a place on it, beside all that lies between, is no longer than so much of the gap to what is known to
// be near, and has so many ticks to be proved.
constexpr double kClear = 0.3;
constexpr int kShortcutTicks = 6;
// What it touched there is looked for in this share of a tick more.
constexpr double kLateShare = 0.2;

}  // namespace

void ContactLoop::find_on_trail(Trail::Side side, const Pose& Y, double travel, double across, OnTrail& nearest,
                                OnTrail& touched) const {
  const double now = metric_.whiten(displacement(X_, Y, center_)).squaredNorm();
  bool away = false;
  const auto offer = [&](double length, OnTrail found, OnTrail& best) {
    if (found.left >= best.left) return;
    const double straight = away ? size(displacement(X_, pose_of(found), center_)) : 0;
    found.across = away && length > std::min(travel, kDetour * straight);
    if (found.across) found.left /= kNearerOnTrail;
    if (found.left < best.left && (!found.across || straight <= across)) best = found;
  };
  double length = 0;
  for (std::size_t i = 1; i <= trail_.count(side); ++i) {
    // On the straight way to the pose.
    const Pose &from = trail_.pose(side, i - 1), &to = trail_.pose(side, i);
    const Displacement straight = displacement(from, to, center_);
    const Vec6 off = metric_.whiten(displacement(from, Y, center_)), way = metric_.whiten(straight);
    const double share = std::clamp(way.dot(off) / std::max(way.squaredNorm(), kRest * kRest), 0.0, 1.0);
    offer(length + share * size(straight), {side, i, share, false, (off - share * way).squaredNorm()}, nearest);
    length += size(straight);
    const double left = (off - way).squaredNorm();
    away = away || left > now;
    if (!trail_.touched_at(side, i)) continue;
    offer(length, {side, i, 1, false, away ? left : 0}, touched);
    if (!away) return;
  }
}

double ContactLoop::least_gap() const {
  double least = std::numeric_limits<double>::infinity();
  for (const Contact& c : at_.contacts->constraints())
    if (c.age != kOneShotAge) least = std::min(least, c.gap);
  return least;
}

Pose ContactLoop::pose_of(const OnTrail& place) const {
  const Pose &from = trail_.pose(place.side, place.pose - 1), &to = trail_.pose(place.side, place.pose);
  return place.share < 1 ? displaced(from, center_, place.share * displacement(from, to, center_)) : to;
}

bool ContactLoop::waits_for_shortcut(const Pose& Y, TickReport& report) {
  const Pose to = pose_of(shortcut_->to);
  const Displacement d = displacement(X_, to, center_);
  const bool nearer = size(displacement(to, Y, center_)) < size(displacement(X_, Y, center_));
  MotionAnswer answer = MotionAnswer::blocked;
  if (nearer && trail_.is_at(X_)) {
    blocking_.clear();
    answer = at_.check->check(X_, d, kGapFloor, blocking_);
    report.flags.timed_out |= answer == MotionAnswer::unknown;
    if (answer == MotionAnswer::unknown && ++shortcut_->ticks < kShortcutTicks) return true;
  }
  const auto made = at_.check->instead().value_or(d);
  if (answer == MotionAnswer::free && size(displacement(displaced(X_, center_, made), to, center_)) < kRest) {
    trail_.crossed_to(shortcut_->to.side, shortcut_->to.pose, to);
    X_ = to;
    tracked_ = false;
    report.substeps.push_back(X_);
    made_ += size(d);
  } else {
    in_vain_ = X_;
  }
  shortcut_.reset();
  return false;
}

bool ContactLoop::comes_back_by(const Displacement& pen) const {
  const Vec6 way = metric_.whiten(pen);
  for (const Trail::Side side : {Trail::Side::back, Trail::Side::ahead})
    for (std::size_t i = 1; i <= trail_.count(side); ++i) {
      if (!trail_.touched_at(side, i)) continue;
      const Vec6 back = metric_.whiten(displacement(X_, trail_.pose(side, i), center_));
      if (back.dot(way) > kComesBack * back.norm() * way.norm()) return true;
    }
  return false;
}

void ContactLoop::follow_trail(const Pose& Y, const Displacement& pen, double travel, TickReport& report) {
  if (!trail_.is_at(X_)) return;
  metric_.set_orientation(X_.q);
  OnTrail to, touched;
  to.left = touched.left = kNearerOnTrail * metric_.whiten(displacement(X_, Y, center_)).squaredNorm();
  const bool comes_back = comes_back_by(pen);
  // Past what is near, a way across takes longer to prove than that to the pen; and so where the pen leaves.
  const double across = comes_back && !same_pose(in_vain_, X_) ? std::min(travel, kClear * least_gap()) : 0;
  for (const Trail::Side side : {Trail::Side::back, Trail::Side::ahead})
    find_on_trail(side, Y, travel, across, to, touched);
  if (touched.pose > 0 && kNearerOnTrail * touched.left <= to.left) to = touched;
  if (to.pose == 0) return;
  const int patience = kPatience * (stuck_ / kTicksOfLooks + (comes_back ? 0 : 1));
  const bool waits = at_.check->goes_on() && stuck_ % kTicksOfLooks < patience;
  if (at_.check->progress() > kMostIsThere && ++waited_ <= kWaitsForRest) return;
  waited_ = 0;
  if (waits && std::sqrt(to.left) > lag_bound(at_.radius)) return;
  // Along the trail it would come there too, but maybe to the other side of what it has been around.
  if (to.across) {
    shortcut_ = Shortcut{to};
    return;
  }
  for (std::size_t i = 1; i <= to.pose && made_ < travel; ++i) {
    const Pose next = trail_.pose(to.side, 1);
    const Displacement whole = displacement(X_, next, center_);
    const double share = std::min(i == to.pose ? to.share : 1.0, (travel - made_) / std::max(size(whole), kRest));
    const Pose from = X_;
    X_ = share < 1 ? displaced(X_, center_, share * whole) : next;
    trail_.went(from, X_);
    report.substeps.push_back(X_);
    made_ += share * size(whole);
  }
  if (made_ == 0) return;
  tracked_ = false;
  owed_.reset();
  // A few contacts are known at once, although the tick's time is over: they hold the part where it was held.
  const auto deadline_ns = deadline_ns_ + static_cast<std::int64_t>(1e9 * kLateShare * settings_.tick_budget);
  trail_.touched(touched_faces_);
  if (!touched_faces_.empty() && at_.contacts->track(X_, at_.reach, deadline_ns)) {
    at_.contacts->seed(touched_faces_, X_, deadline_ns);
    tracked_ = true;
  }
}

}  // namespace tegotae
