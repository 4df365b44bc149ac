// Motions that are looked at as a whole, where cells and fronts would take longer, and the ways that are proved so.
#include <algorithm>
#include <cmath>
#include <limits>

#include "narrowphase/patch_motion_check.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

// What is looked at as a whole goes on for as far as the pen comes in so many ticks, and for this share of the part's
// radius at most.
constexpr double kSweptTicks = 50, kLongestSweep = 0.5;
// A goes along a way that is proved where that leaves no more than this share of what is wanted.
constexpr double kWayLeaves = 0.5;
// Poses are the same that differ by less than this share of the size of the scene: a tenth of the rounding that
// certificates leave room for.
constexpr double kSamePlace = 1e-13;
// Near parts that are no bundle, at most: all lists are gone through for each of them.
constexpr std::size_t kMostSwept = 256;
// What a face takes at most, in ticks of which the spare time goes to ways ahead.
constexpr double kTicksPerFace = 1e-3;
// The pen keeps its direction up to this cosine; motions of it in a tick that are none, m.
constexpr double kSameWay = 0.95, kStands = 1e-7;
// The ticks that the pen takes to come as far as whole blocks of faces are to prove at least, of a part of no more than
// some faces and for each face: half as much again as the look at them takes. Fewer faces are looked at one by one.
constexpr double kWorthTicks = 3, kWorthTicksPerFace = 1.5e-4;
constexpr std::size_t kManyFaces = 1U << 12;
// What has come less far (m) stands.
constexpr double kStill = 1e-6;

}  // namespace

bool PatchMotionCheck::sweeps(const Pose& X, const Displacement& d) const noexcept {
  if (!may_sweep() ||
      size(displacement(sweep_->start(), X, center_)) > kSamePlace * (X.p.norm() + center_.norm() + radius_) ||
      !covers_near(sweep_->near()))
    return false;
  const Displacement& other = sweep_->motion();
  return d.dp.dot(other.dp) + radius_ * radius_ * d.dr.dot(other.dr) > 0;
}

void PatchMotionCheck::count_still(const Pose& X) noexcept {
  if (still_since_ == now_) return;
  still_since_ = now_;
  const bool still = behind_for_ > 0 && size(displacement(still_X_, X, center_)) < kStill;
  still_for_ = still ? still_for_ + 1 : 0;
  if (!still) still_X_ = X;
}

/// At rest cells are to have the time: the last sweep brought nothing, and the pen stands.
bool PatchMotionCheck::rests(const Displacement& d) noexcept {
  if (size(pen_) > kStands) brought_nothing_ = false;
  return size(d) < kStill || (touches_ && brought_nothing_);
}

bool PatchMotionCheck::may_sweep() const noexcept {
  return sweep_ && limit_.deadline_ns != kNoDeadline && others_ == OtherParts::far &&
         (bundled_ || near_.size() <= kMostSwept);
}

/// What touches goes on by short motions in many directions. Fronts know better, as long as they are not behind.
bool PatchMotionCheck::may_go_along() const noexcept {
  return may_sweep() && trusted_ && !touches_ && (!near_cells_.empty() || behind_);
}

bool PatchMotionCheck::goes_along(const Pose& X, const Displacement& d, std::vector<FacePair>& blocking) noexcept {
  if (!may_go_along()) return false;
  way_.come_to(X);
  if (next_way_.is_on(X)) {
    way_ = next_way_;
    met_ = next_met_;
    next_way_.drop();
    way_.come_to(X);
  }
  const auto along = way_.toward(X, d);
  if (!along || !covers_near(way_.parts())) return false;
  // Near the end, what nearly touches turns a motion away from the way: it is come to all the same.
  const bool arrives =
      !met_.empty() && !way_.done() && size(*along) > kStands && way_.ends_at(displaced(X, center_, *along));
  if (left_of(X, d, *along) > kWayLeaves * size(d) && !arrives) return false;
  if (way_.ends_at(displaced(X, center_, *along))) tell(met_, blocking);
  forget_small_cells(*along);
  instead_ = along;
  return true;
}

std::optional<Displacement> PatchMotionCheck::onto_way(const Pose& X, const Displacement& d) const noexcept {
  if (!may_go_along() || !covers_near(way_.parts())) return std::nullopt;
  const auto onto = way_.join(X, d);
  if (!onto || left_of(X, d, *onto) > kWayLeaves * size(d)) return std::nullopt;
  return onto;
}

double PatchMotionCheck::left_of(const Pose& X, const Displacement& d, const Displacement& made) const noexcept {
  return size(displacement(displaced(X, center_, made), displaced(X, center_, d), center_));
}

bool PatchMotionCheck::covers_near(const std::vector<std::uint32_t>& parts) const noexcept {
  const auto has = [&parts](std::uint32_t part) { return std::find(parts.begin(), parts.end(), part) != parts.end(); };
  const bool all = bundle_ && has(static_cast<std::uint32_t>(fixed_.size()));
  return std::all_of(near_.begin(), near_.end(),
                     [&](std::uint32_t part) { return (all && bundle_->has(part)) || has(part); });
}

bool PatchMotionCheck::find_swept(const Pose& X, const Pose& from, const Displacement& d) noexcept {
  const auto nothing_inside = [&](std::uint32_t part) {
    return trusted_ && (sides_[part].known || !past(limit_.deadline_ns)) && sides_of(part, X).b_outside;
  };
  swept_.clear();
  outside_.clear();
  if (bundle_) {
    bool outside = true;
    for (std::uint32_t part = 0; part < fixed_.size() && outside; ++part)
      if (bundle_->has(part)) outside = nothing_inside(part);
    swept_.push_back(static_cast<std::uint32_t>(fixed_.size()));
    outside_.push_back(outside);
  }
  const double reach = size(d) + radius_;
  for (std::uint32_t part = 0; part < fixed_.size(); ++part) {
    if (bundle_ && bundle_->has(part)) continue;
    const double far = (poses_[part] * fixed_[part]->origin() - from * center_).norm() - fixed_[part]->radius();
    const bool near = std::find(near_.begin(), near_.end(), part) != near_.end();
    if (!near && (far > reach || left_out_[part])) continue;
    swept_.push_back(part);
    outside_.push_back(nothing_inside(part));
  }
  return std::all_of(swept_.begin(), swept_.end(), [this](std::uint32_t part) { return sweep_->knows(part); });
}

bool PatchMotionCheck::same_way(const Displacement& a, const Displacement& b) const noexcept {
  const auto product = [this](const Displacement& x, const Displacement& y) {
    return x.dp.dot(y.dp) + radius_ * radius_ * x.dr.dot(y.dr);
  };
  return product(a, b) > kSameWay * std::sqrt(product(a, a) * product(b, b));
}

bool PatchMotionCheck::begin_sweep(const Pose& X, const Displacement& d, double clearance) noexcept {
  // It takes as long however far it goes, and meanwhile the pen goes on. Aside, contacts may be in the way of that.
  const double ticks = !touches_ && same_way(d, pen_)
                           ? std::min(kSweptTicks, kLongestSweep * radius_ / std::max(size(pen_), kStands))
                           : 0;
  const Displacement all = {d.dp + ticks * pen_.dp, d.dr + ticks * pen_.dr};
  if (!find_swept(X, X, all)) return false;
  sweep_->begin(X, all, swept_, outside_, clearance, worth());
  return true;
}

double PatchMotionCheck::worth() const noexcept {
  const std::size_t faces = held_->mesh().triangles.size();
  if (touches_ || faces < kManyFaces || !(size(pen_) > kStands)) return std::numeric_limits<double>::infinity();
  return (kWorthTicks + kWorthTicksPerFace * static_cast<double>(faces)) * size(pen_);
}

void PatchMotionCheck::finish_way() noexcept {
  looks_ahead_ = false;
  if (!(sweep_->share() > 0)) {
    lead_ *= 0.5;
    return;
  }
  lead_ = 1;
  const bool goes_on = way_.is_on(sweep_->start());
  (goes_on ? next_way_ : way_).set(sweep_->start(), sweep_->share() * sweep_->motion(), sweep_->near());
  (goes_on ? next_met_ : met_) = sweep_->blocking();
  rough_end_ = sweep_->ended_by_blocks();
}

/// A way ahead of A is looked at as a whole in the time that is left: it begins where A will be by then.
void PatchMotionCheck::prepare_way(const Pose& X) noexcept {
  if (!may_go_along() || sweeping_ || !(size(pen_) > kStands)) return;
  const double faces = static_cast<double>(held_->mesh().triangles.size());
  const double ticks = std::max(2.0, lead_ * kTicksPerFace * faces);
  const bool on_way = way_.is_on(X);
  looks_ahead_ = looks_ahead_ && same_way(sweep_->motion(), pen_) && covers_near(sweep_->near());
  if (!looks_ahead_) {
    const bool covered = covers_near(way_.parts());
    if (covered && (next_way_.known() || way_.leads_on(X, ticks * pen_) || (on_way && !met_.empty()))) return;
    const double length = size(pen_);
    const double far = std::min(kSweptTicks + ticks, kLongestSweep * radius_ / length);
    if (ticks > far) return;
    const Pose from = on_way ? way_.end() : displaced(X, center_, ticks * pen_);
    if (!find_swept(X, from, far * pen_)) return;
    // Blocks of faces that ended a way would end the next one at once.
    sweep_->begin(from, far * pen_, swept_, outside_, clearance_,
                  on_way && rough_end_ ? std::numeric_limits<double>::infinity() : worth());
    looks_ahead_ = true;
  }
  if (sweep_->go_on(limit_.deadline_ns)) finish_way();
}

MotionAnswer PatchMotionCheck::ask_sweep(const Displacement& d, std::vector<FacePair>& blocking) noexcept {
  blocking.clear();
  instead_ = d;
  if (!sweep_->go_on(limit_.deadline_ns) || past(limit_.deadline_ns)) {
    share_ = 0;
    return MotionAnswer::unknown;
  }
  sweeping_ = false;
  next_way_.drop();
  const Pose& X = sweep_->start();
  const Displacement free = sweep_->share() * sweep_->motion();
  way_.set(X, free, sweep_->near());
  share_ = 1;
  // What was met is told where the pen has come to it.
  const auto along = way_.toward(X, d);
  instead_ = along ? *along : Displacement{};
  met_ = sweep_->blocking();
  rough_end_ = sweep_->ended_by_blocks();
  if (way_.ends_at(displaced(X, center_, *instead_))) tell(met_, blocking);
  brought_nothing_ = size(*instead_) < kStill;
  forget_small_cells(*instead_);
  return answer(blocking);
}

}  // namespace tegotae
