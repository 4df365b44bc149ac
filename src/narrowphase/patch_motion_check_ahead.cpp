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

}  // namespace tegotae
