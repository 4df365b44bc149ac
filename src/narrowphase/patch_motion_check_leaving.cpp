// Motions that only lead away from parts that are certified by cells.
#include <algorithm>

#include "narrowphase/patch_motion_check.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

// Where A has left by this part of it, cells from before are too small: with a whole edge, what comes back renews them
// all.
constexpr double kLeftEdges = 0.3;
/// Where a motion leaves, few pairs tell (35 in the median of a sheet of 7000 triangles); where it does not, that many
/// are lost. Walls of many parts take thousands, which is worth it when the cells are behind.
constexpr int kFewPairs = 128;
/// Ticks after which what was too much is tried again, at most.
constexpr std::uint64_t kLongestWait = 32;

}  // namespace

void PatchMotionCheck::jumped() noexcept {
  ways_.drop();
  sweeping_ = looks_ahead_ = false;
  sides_.assign(sides_.size(), Sides{});
  waits_for_sides_ = 0;
}

const PatchMotionCheck::Sides& PatchMotionCheck::sides_of(std::uint32_t part, const Pose& X) noexcept {
  Sides& sides = sides_[part];
  if (sides.known) return sides;
  const Body &A = held_body_, &B = bodies_[part];
  const Pose X_BA = poses_[part].inverse() * X, to_held = X.inverse();
  sides = {true, B.facing && !A.points.empty(), A.facing && !B.points.empty()};
  for (const Vec3& p : A.points) sides.a_outside = sides.a_outside && B.facing->outside(X_BA * p);
  for (const Vec3& p : B.points) sides.b_outside = sides.b_outside && A.facing->outside(to_held * p);
  return sides;
}

bool PatchMotionCheck::only_leaves(const Pose& X, const Displacement& d, double clearance) noexcept {
  if (!trusted_ || (d.dp.isZero(0) && d.dr.isZero(0))) return false;
  const bool thorough = behind_ && now_ >= retry_leaving_ && cells_->leads_away(d.dp);
  const int most = thorough ? LeavingCheck::kMostVisits : kFewPairs;
  // Of many parts as one, all that are near.
  bool a_outside = true, b_outside = true;
  for (const std::uint32_t part : near_) {
    if (!bundled_ || !bundle_->has(part)) continue;
    if (!sides_[part].known && past(limit_.deadline_ns)) return false;
    const Sides& sides = sides_of(part, X);
    a_outside = a_outside && sides.a_outside;
    b_outside = b_outside && sides.b_outside;
  }
  for (const std::uint32_t part : near_cells_) {
    if (past(limit_.deadline_ns)) return false;
    const bool single = part < fixed_.size();
    const Sides sides = single ? sides_of(part, X) : Sides{true, a_outside && bundle_facing_, b_outside};
    const PatchTree& tree = single ? *fixed_[part] : *bundle_->tree();
    const Facing* facing = single ? bodies_[part].facing.get() : bundle_facing_.get();
    const Pose pose = single ? poses_[part] : Pose{};
    const Quat q = pose.q.conjugate();
    const Sweep sweep(pose.inverse() * X, {q * d.dp, q * d.dr}, center_, tree,
                      held_->radius() + (held_->origin() - center_).norm(), clearance);
    if (!leaving_.leaves({held_.get(), sides.b_outside ? held_body_.facing.get() : nullptr}, center_,
                         {&tree, sides.a_outside ? facing : nullptr}, sweep, most, limit_.deadline_ns)) {
      if (thorough && leaving_.visits() > kFewPairs) {
        wait_ = std::min(2 * wait_ + 2, kLongestWait);
        retry_leaving_ = now_ + wait_;
      }
      return false;
    }
  }
  wait_ = 0;
  return true;
}

void PatchMotionCheck::forget_small_cells(const Displacement& d) noexcept {
  const double before = left_;
  left_ += d.dp.norm() + radius_ * d.dr.norm();
  const double far = kLeftEdges * edge_;
  if (before > far || left_ <= far) return;
  cells_->forget_cut();
  cells_->set_near(near_cells_);
  headway_.restart();
}

}  // namespace tegotae
