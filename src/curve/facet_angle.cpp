#include "curve/facet_angle.hpp"

#include <algorithm>
#include <cmath>

namespace tegotae {
namespace {

/// A corner of a chord of length d over the radius r is off by d / 2r, and more where the facet is no chord's half; so
/// much (rad) is explained at most.
constexpr double kWidthShare = 0.75, kMaxWidth = 0.15;

}  // namespace

double angle_at_middle(const Facet& f, const ScrewMotion& m) {
  const Vec3 v = m.velocity(chord_middle(f, m));
  const double speed = v.norm();
  return speed > 0 ? std::abs(f.normal.dot(v)) / speed : 0;
}

double angle_off(const Facet& f, const ScrewMotion& m) {
  const Vec3 middle = m.velocity(f.center);
  const double speed2 = middle.squaredNorm();
  if (!(speed2 > 0)) return 1;
  double width = 0, worst = 0;
  for (const Vec3& e : f.edge) width = std::max(width, std::abs(e.dot(middle)));
  for (const Vec3& x : f.corners()) {
    const Vec3 v = m.velocity(x);
    const double speed = v.norm();
    worst = std::max(worst, speed > 0 ? std::abs(f.normal.dot(v)) / speed : 1.0);
  }
  return std::max(0.0, worst - std::min(kWidthShare * width / speed2, kMaxWidth));
}

}  // namespace tegotae
