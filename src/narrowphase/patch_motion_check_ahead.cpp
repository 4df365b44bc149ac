// What is proved in the time that a tick leaves over, for the next ones.
#include <algorithm>
#include <cmath>
#include <limits>

#include "narrowphase/patch_motion_check.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

// What is asked ahead of a front stops at so many pairs.
constexpr int kEnoughPairs = 4000;
// What is proved ahead: this share of the gap, when less than so much of it is proved; no less than this (m).
constexpr double kAheadShare = 0.5, kAheadEnough = 0.35, kMinAhead = 30e-6;
// The share of a tick's spare time that goes to the way ahead.
constexpr double kWayShare = 0.9;
// Ways ahead are longer by so many ticks for each face: what looking at it takes at most.
constexpr double kTicksPerFace = 1e-3;

}  // namespace

double PatchMotionCheck::least_gap_at_most(const Pose& X, std::uint32_t part) const noexcept {
  // Down both hierarchies to the child that is nearest: some two faces that are near.
  const PatchTree &A = *held_, &B = *fixed_[part];
  const Pose X_BA = poses_[part].inverse() * X;
  std::uint32_t a = 0, b = 0;
  const auto center_a = [&](std::uint32_t node) -> Vec3 { return X_BA * (A.origin() + A.nodes()[node].center_vec()); };
  const auto center_b = [&](std::uint32_t node) -> Vec3 { return B.origin() + B.nodes()[node].center_vec(); };
  while (!A.nodes()[a].leaf() || !B.nodes()[b].leaf()) {
    const PatchNode &na = A.nodes()[a], &nb = B.nodes()[b];
    if (nb.leaf() || (!na.leaf() && na.half[0] > nb.half[0])) {
      const Vec3 other = center_b(b);
      a = na.first +
          ((center_a(na.first) - other).squaredNorm() <= (center_a(na.first + 1) - other).squaredNorm() ? 0 : 1);
    } else {
      const Vec3 other = center_a(a);
      b = nb.first +
          ((center_b(nb.first) - other).squaredNorm() <= (center_b(nb.first + 1) - other).squaredNorm() ? 0 : 1);
    }
  }
  const std::uint32_t face_a = A.order()[A.nodes()[a].first], face_b = B.order()[B.nodes()[b].first];
  double least2 = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      least2 = std::min(least2, (X_BA * A.corner(face_a, i) - B.corner(face_b, k)).squaredNorm());
  return std::sqrt(least2);
}

template <typename Ask>
void PatchMotionCheck::look_ahead(const Pose& X, Ahead& ahead, double at_most, Ask ask) noexcept {
  const Displacement since = displacement(ahead.X, X, center_);
  const double moved = since.dp.norm() + radius_ * since.dr.norm();
  ahead.X = X;
  ahead.proved = std::max(0.0, ahead.proved - moved);
  ahead.ceiling = std::min(ahead.ceiling + moved, at_most);
  while (!past(limit_.deadline_ns)) {
    const double target = kAheadShare * ahead.ceiling;
    if (target < kMinAhead || ahead.proved >= kAheadEnough * ahead.ceiling || ahead.proved >= longest_motion()) return;
    const CertifyStatus status = ask(target);
    if (status == CertifyStatus::out_of_budget) return;
    if (status == CertifyStatus::certified) ahead.proved = target;
    if (status == CertifyStatus::blocked) ahead.ceiling = target;
  }
}

void PatchMotionCheck::prepare(const Pose& X, const Displacement& next, std::int64_t deadline_ns) noexcept {
  limit_.deadline_ns = deadline_ns;
  limit_.blocking = 1;
  // Ways first: where they are proved, fronts are not needed.
  const std::int64_t now_ns = monotonic_ns();
  limit_.deadline_ns = now_ns + static_cast<std::int64_t>(kWayShare * static_cast<double>(deadline_ns - now_ns));
  prepare_way(X, next);
  limit_.deadline_ns = deadline_ns;
  prepare_fronts(X);
  prepare_cells(X, next);
}

void PatchMotionCheck::prepare_fronts(const Pose& X) noexcept {
  limit_.searches = kFrontSearches;
  for (std::size_t i = 0; i < near_fronts_.size() && !past(limit_.deadline_ns);) {
    const std::uint32_t part = near_fronts_[i++];
    bool to_cells = false;
    look_ahead(X, ahead_[front_of_[part]], least_gap_at_most(X, part), [&](double clearance) {
      const CertifyReport report = ask_front(part, X, {}, clearance, limit_);
      to_cells = lies_on(report, part);
      return to_cells || report.pairs > kEnoughPairs ? CertifyStatus::out_of_budget : report.status;
    });
    if (!to_cells) continue;
    move_to_cells(part);
    near_cells_.push_back(part);
    near_fronts_.erase(near_fronts_.begin() + static_cast<std::ptrdiff_t>(--i));
    cells_->set_near(near_cells_);
    headway_.restart();
  }
}

void PatchMotionCheck::prepare_cells(const Pose& X, const Displacement& next) noexcept {
  if (near_cells_.empty() || !headway_.go(X, next)) return;
  limit_.searches = kCellSearches;
  while (!past(limit_.deadline_ns) && headway_.wants_more() && !cells_->crowded()) {
    const Displacement d = headway_.motion();
    const CertifyReport report = cells_->prove_ahead(X, d, limit_);
    headway_.learn(report.share, cells_->met());
    if (report.status == CertifyStatus::out_of_budget) return;
  }
}

Displacement PatchMotionCheck::onto_pen_way(const Pose& from, const Pose& pen, double ticks) const noexcept {
  const Displacement &step = heading_.pen, to_pen = displacement(from, pen, center_);
  const double beside = beside_pen(to_pen);
  if (beside > heading_.near_gap) ticks = std::min(ticks, soon() + beside / size(step));
  // From where it is nearest to `from`, or from `pen`.
  ticks += std::max(0.0, -product(to_pen, step) / product(step, step));
  return displacement(from, displaced(pen, center_, ticks * step), center_);
}

/// A way ahead of A is looked at as a whole in the time that is left. It begins here, and holds from where A will have
/// come to by then.
void PatchMotionCheck::prepare_way(const Pose& X, const Displacement& next) noexcept {
  if (!may_look_ahead() || sweeping_ || heading_.whole || !(size(heading_.pen) > kStands)) return;
  ways_.come_to(X);
  looks_ahead_ = looks_ahead_ && same_way(pen_then_, heading_.pen) && covers_near(sweep_->near());
  if (!looks_ahead_ && !begin_ahead(X, next)) return;
  looks_ahead_ = true;
  if (sweep_->go_on(limit_.deadline_ns)) finish_way(X);
}

/// Where A will be when a look that begins now is done: on the first way, as near to the pen as it comes there. None
/// where looks are slow: they come too late, and back along the way A comes to what it touched in no time.
std::optional<Pose> PatchMotionCheck::place_soon(const Pose& X, const Displacement& next) const noexcept {
  if (now_ < slow_until_) return std::nullopt;
  const Displacement& pen = heading_.pen;
  const auto along = ways_.first().way.toward(X, {next.dp + soon() * pen.dp, next.dr + soon() * pen.dr});
  if (!along) return std::nullopt;
  return displaced(X, center_, *along);
}

bool PatchMotionCheck::begin_ahead(const Pose& X, const Displacement& next) noexcept {
  const auto leads_on = [&](const ProvedWay& way) { return way.is_on(X) || way.leads_on(X, heading_.pen); };
  const bool on_way = !ways_.empty() && covers_near(ways_.last().way.parts()) && leads_on(ways_.first().way);
  if (on_way && ways_.full()) return false;
  const Pose pen = displaced(X, center_, next);
  const double faces = static_cast<double>(held_->mesh().triangles.size()), step = size(heading_.pen);
  const double far = std::min(kSweptTicks + kTicksPerFace * faces, kLongestSweep * radius_ / step);
  std::optional<Pose> from = X;
  turns_off_ = false;
  if (on_way) {
    const ProvedWay& last = ways_.last().way;
    const double left = size(displacement(X, last.end(), center_));
    const bool onto_pen = product(last.motion(), heading_.pen) > 0 &&
                          beside_pen(displacement(last.end(), pen, center_)) <= heading_.near_gap;
    turns_off_ = !onto_pen && !(same_way(last.motion(), heading_.pen) && left <= 2 * soon() * step);
    // What is met at its end would end the next one at once.
    if (!turns_off_ && (!ways_.last().met.empty() || left > far * step)) return false;
    from = turns_off_ ? place_soon(X, next) : last.end();
  }
  if (!from) return false;
  const Displacement d = onto_pen_way(*from, pen, far);
  if (!find_swept(X, *from, d)) return false;
  look_at(*from, d, clearance_, worth({}, d));
  pen_then_ = heading_.pen;
  ahead_since_ = now_;
  return true;
}

void PatchMotionCheck::finish_way(const Pose& X) noexcept {
  looks_ahead_ = false;
  lasted(now_ - ahead_since_ + 1);
  if (!(sweep_->share() > 0)) return;
  if (turns_off_) {
    const Displacement left = displacement(X, sweep_->start(), center_);
    // A has come past the place where it begins.
    if (product(left, heading_.pen) < 0 && size(left) > kStill) return;
    ways_.turn_off(X, sweep_->start());
  }
  add_way();
}

}  // namespace tegotae
