#include "curve/facet_angle.hpp"

#include <algorithm>
#include <cmath>

namespace tegotae {
namespace {

/// A corner of a chord of length d over the radius r is off by d / 2r, and more where the facet is not half a chord; so
/// much (rad) is explained at most.
constexpr double kWidthShare = 0.75, kMaxWidth = 0.15;
/// Squares that differ by less than this part of them are told apart by the angles themselves.
constexpr double kClear = 1e-9;

/// What the width of a facet across the motion `middle` of its center explains, rad.
double explained(const Facet& f, const Vec3& middle, double speed2) {
  double width = 0;
  for (const Vec3& e : f.edge) width = std::max(width, std::abs(e.dot(middle)));
  return std::min(kWidthShare * width / speed2, kMaxWidth);
}

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
  double worst = 0;
  for (const Vec3& x : f.corner) {
    const Vec3 v = m.velocity(x);
    const double speed = v.norm();
    worst = std::max(worst, speed > 0 ? std::abs(f.normal.dot(v)) / speed : 1.0);
  }
  return std::max(0.0, worst - explained(f, middle, speed2));
}

bool is_within(const Facet& f, const ScrewMotion& m, double tolerance) {
  // Most facets that are asked about are far off, and squares tell: no root, and at the first corner no width.
  std::array<double, 3> across2, speed2;
  const auto visit = [&](std::size_t i) {
    const Vec3 v = m.velocity(f.corner[i]);
    const double across = f.normal.dot(v);
    across2[i] = across * across;
    speed2[i] = v.squaredNorm();
  };
  const auto exceeds = [&](std::size_t i, double limit2) { return across2[i] > (1 + kClear) * limit2 * speed2[i]; };
  visit(0);
  if (exceeds(0, (tolerance + kMaxWidth) * (tolerance + kMaxWidth))) return false;
  const Vec3 middle = m.velocity(f.center);
  const double middle2 = middle.squaredNorm();
  if (!(middle2 > 0)) return angle_off(f, m) <= tolerance;
  const double limit = tolerance + explained(f, middle, middle2);
  visit(1);
  visit(2);
  bool clear = true;
  for (std::size_t i = 0; i < 3; ++i) {
    if (exceeds(i, limit * limit)) return false;
    clear = clear && across2[i] < (1 - kClear) * limit * limit * speed2[i];
  }
  return clear || angle_off(f, m) <= tolerance;
}

}  // namespace tegotae
