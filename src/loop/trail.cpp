#include "loop/trail.hpp"

#include <algorithm>
#include <utility>

#include "core/same_pose.hpp"

namespace tegotae {
namespace {

/// What is off a straight motion by less than this share of the size of the scene is on it: a tenth of the rounding
/// that certificates leave room for.
constexpr double kOnWay = 1e-13;

}  // namespace

Trail::Trail(const Vec3& center, double radius) : center_(center), radius_(radius), places_(kPoses) {}

bool Trail::is_at(const Pose& X) const noexcept {
  return count_ > 0 && same_pose(place(here_).X, X);
}

void Trail::went(const Pose& from, const Pose& to) noexcept {
  if (same_pose(from, to)) return;
  if (!is_at(from)) {
    forget();
    add(from);
  }
  for (const Side side : {Side::back, Side::ahead})
    while (count(side) > 0 && passes(place(here_).X, to, pose(side, 1))) here_ = number(side, 1);
  if (same_pose(place(here_).X, to)) return;
  for (const Side side : {Side::back, Side::ahead})
    if (count(side) > 0 && passes(place(here_).X, pose(side, 1), to)) return split(side, to);
  turn_off();
  add(to);
}

/// Whether `X` is on the straight way between two poses.
bool Trail::passes(const Pose& from, const Pose& to, const Pose& X) const noexcept {
  const auto product = [this](const Displacement& a, const Displacement& b) {
    return a.dp.dot(b.dp) + radius_ * radius_ * a.dr.dot(b.dr);
  };
  const Displacement whole = displacement(from, to, center_), part = displacement(from, X, center_);
  const double length2 = product(whole, whole), share = product(whole, part) / length2;
  if (!(share >= 0 && share <= 1)) return false;
  const Displacement off = displacement(displaced(from, center_, share * whole), X, center_);
  return off.dp.norm() + radius_ * off.dr.norm() <= kOnWay * (from.p.norm() + center_.norm() + radius_);
}

/// How many poses away it touched something.
std::size_t Trail::nearest_touched(Side side) const noexcept {
  std::size_t i = 1;
  while (i <= count(side) && !touched_at(side, i)) ++i;
  return i <= count(side) ? i : kPoses;
}

/// The part goes a way of its own from where it is.
void Trail::turn_off() noexcept {
  if (nearest_touched(Side::ahead) < nearest_touched(Side::back)) {
    while (here_ > 0) drop_first();
    for (std::size_t i = 0; i < count_ / 2; ++i) std::swap(place(i), place(count_ - 1 - i));
    here_ = count_ - 1;
  }
  count_ = here_ + 1;
}

void Trail::crossed_to(Side side, std::size_t i, const Pose& X) noexcept {
  const std::size_t at = number(side, i);
  if (same_pose(place(at).X, X))
    here_ = at;
  else
    insert(side == Side::back ? at + 1 : at, X);
}

/// The part goes to `X`, between where it is and the next pose on a side.
void Trail::split(Side side, const Pose& X) noexcept {
  const Side other = side == Side::back ? Side::ahead : Side::back;
  const bool on_the_way = count(other) == 0 || passes(X, pose(other, 1), place(here_).X);
  if (place(here_).touched > 0 || !on_the_way) return insert(side == Side::back ? here_ : here_ + 1, X);
  place(here_).X = X;
}

/// The part is at `X`, which is number `at` from now on.
void Trail::insert(std::size_t at, const Pose& X) noexcept {
  if (count_ == kPoses && at > 1) {
    drop_first();
    --at;
  }
  if (count_ == kPoses) --count_;
  for (std::size_t i = count_++; i > at; --i) place(i) = place(i - 1);
  here_ = at;
  place(at).X = X;
  place(at).touched = 0;
}

void Trail::drop_first() noexcept {
  first_ = (first_ + 1) % kPoses;
  --count_;
  --here_;
}

void Trail::add(const Pose& X) noexcept {
  if (count_ == kPoses) drop_first();
  here_ = count_++;
  place(here_).X = X;
  place(here_).touched = 0;
}

void Trail::touches(const std::vector<FacePair>& faces) noexcept {
  Place& here = place(here_);
  here.touched = std::min(faces.size(), kFaces);
  std::copy_n(faces.begin(), here.touched, here.faces.begin());
}

void Trail::touched(std::vector<FacePair>& faces) const noexcept {
  const Place& at = place(here_);
  faces.assign(at.faces.begin(), at.faces.begin() + static_cast<std::ptrdiff_t>(at.touched));
}

}  // namespace tegotae
