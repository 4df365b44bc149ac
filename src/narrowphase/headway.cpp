#include "narrowphase/headway.hpp"

#include <algorithm>
#include <cmath>

namespace tegotae {
namespace {

// Shorter motions have no direction (m).
constexpr double kRest = 1e-7;
// Directions are the same while the cosine between them is more than this.
constexpr double kSameDirection = 0.9;
// What is looked at of the way to what was met, and which part of that has to be proved.
constexpr double kShare = 0.9, kEnough = 0.9;
// A shorter way is not worth a look (m).
constexpr double kShortest = 30e-6;

}  // namespace

bool Headway::go(const Pose& X, const Displacement& d) noexcept {
  const auto size = [this](const Displacement& by) { return by.dp.norm() + radius_ * by.dr.norm(); };
  const double carried = size(d);
  if (!(carried > kRest)) return false;
  const double moved = size(displacement(X_, X, center_));
  // Turns count as the way of the points that they carry farthest.
  const double along = d.dp.dot(step_.dp) + radius_ * radius_ * d.dr.dot(step_.dr);
  const double lengths = std::sqrt((d.dp.squaredNorm() + radius_ * radius_ * d.dr.squaredNorm()) *
                                   (step_.dp.squaredNorm() + radius_ * radius_ * step_.dr.squaredNorm()));
  const bool same = along > kSameDirection * lengths;
  proved_ = same ? std::max(0.0, proved_ - moved) : 0;
  met_ = same ? std::max(0.0, met_ - moved) : std::numeric_limits<double>::infinity();
  X_ = X;
  step_ = d;
  carried_ = carried;
  return true;
}

double Headway::target() const {
  return std::min(longest_, kShare * met_);
}

bool Headway::wants_more() const {
  return target() > kShortest && proved_ < kEnough * target();
}

Displacement Headway::motion_of(double length) const {
  return (length / carried_) * step_;
}

void Headway::learn(double proved, double met) noexcept {
  const double length = target();
  proved_ = std::max(proved_, proved * length);
  if (met < 1) met_ = std::min(met_, met * length);
}

void Headway::restart() noexcept {
  step_ = {};
}

}  // namespace tegotae
