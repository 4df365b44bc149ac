#include "loop/trail.hpp"

#include <algorithm>

namespace tegotae {
namespace {

/// What is off a straight motion by less than this share of the size of the scene is on it: a tenth of the rounding
/// that certificates leave room for.
constexpr double kOnWay = 1e-13;

bool same(const Pose& a, const Pose& b) {
  return a.p == b.p && a.q.coeffs() == b.q.coeffs();
}

}  // namespace

Trail::Trail(const Vec3& center, double radius) : center_(center), radius_(radius), places_(kPoses) {}

bool Trail::is_at(const Pose& X) const noexcept {
  return count_ > 0 && same(pose(0), X);
}

void Trail::went(const Pose& from, const Pose& to) noexcept {
  if (same(from, to)) return;
  if (!is_at(from)) {
    count_ = 0;
    add(from);
  }
  while (count_ > 1 && passes(pose(0), to, pose(1))) go_back();
  if (same(pose(0), to)) return;
  if (count_ > 1 && passes(pose(0), pose(1), to)) go_back();
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

void Trail::add(const Pose& X) noexcept {
  if (count_ == kPoses) {
    first_ = (first_ + 1) % kPoses;
    --count_;
  }
  ++count_;
  here().X = X;
  here().touched = 0;
}

void Trail::touches(const std::vector<FacePair>& faces) noexcept {
  here().touched = std::min(faces.size(), kFaces);
  std::copy_n(faces.begin(), here().touched, here().faces.begin());
}

void Trail::touched(std::vector<FacePair>& faces) const noexcept {
  const Place& at = place(0);
  faces.assign(at.faces.begin(), at.faces.begin() + static_cast<std::ptrdiff_t>(at.touched));
}

}  // namespace tegotae
