#include "curve/axis_judge.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "curve/axis_family.hpp"
#include "curve/facet_angle.hpp"

namespace tegotae {
namespace {

/// A surface that turns about an axis has normals in at least so many of the sectors around it; prisms do not.
constexpr int kSectors = 32, kMinSectors = 8;
constexpr double kSectorShare = 0.002;

}  // namespace

double AxisJudge::share_within(const ScrewMotion& motion, double tolerance, std::size_t stride) const {
  double in = 0, all = 0;
  for (std::size_t i = 0; i < facets_.all.size(); i += stride) {
    const Facet& f = facets_.all[i];
    all += f.area;
    if (free_[i] && !is_end(f, motion) && is_within(f, motion, tolerance)) in += f.area;
  }
  return all > 0 ? in / all : 0;
}

double AxisJudge::share_at(const ScrewMotion& motion) const {
  double in = 0;
  for (std::size_t i = 0; i < facets_.all.size(); ++i)
    if (free_[i] && !is_end(facets_.all[i], motion) && angle_at_middle(facets_.all[i], motion) < kSharpTolerance)
      in += facets_.all[i].area;
  return in / facets_.area;
}

double AxisJudge::share_beside(const ScrewMotion& motion) const {
  const ScrewMotion plain = with_rise(motion, -motion.rise());
  double in = 0;
  for (std::size_t i = 0; i < facets_.all.size(); ++i) {
    const Facet& f = facets_.all[i];
    if (!free_[i] || is_end(f, motion)) continue;
    if (is_within(f, motion, kAxisTolerance) ||
        (is_within(f, motion, 4 * kAxisTolerance) && !(angle_at_middle(f, plain) < kSharpTolerance)))
      in += f.area;
  }
  return in / facets_.area;
}

bool AxisJudge::turns(const std::vector<std::size_t>& of, const ScrewMotion& motion) const {
  std::array<double, kSectors> sector{};
  double all = 0;
  const Vec3 u = motion.c.unitOrthogonal(), v = motion.c.cross(u);
  for (const std::size_t i : of) {
    const Facet& f = facets_.all[i];
    if (is_end(f, motion)) continue;
    // Which of the two sides a face shows is not known of all meshes; its place tells.
    const Vec3 x = f.center - motion.axis_point();
    const double x_u = x.dot(u), x_v = x.dot(v);
    const double side = f.normal.dot(x_u * u + x_v * v) < 0 ? -1 : 1;
    const double angle = std::atan2(side * f.normal.dot(v), side * f.normal.dot(u));
    sector[static_cast<std::size_t>((angle / 6.283185307179586 + 1) * kSectors) % kSectors] += f.area;
    all += f.area;
  }
  return std::count_if(sector.begin(), sector.end(), [&](double a) { return a > kSectorShare * all; }) >= kMinSectors;
}

}  // namespace tegotae
