#pragma once

#include <array>
#include <vector>

#include "tegotae/core/pose.hpp"

namespace tegotae {

/// What the search for axes knows of a triangle, in lengths of the mesh's size, from the middle of its box.
struct Facet {
  Vec3 center, normal;
  std::array<Vec3, 3> edge, corner;
  double area;
};

/// An instantaneous screw motion: the point x moves by c_bar + c × x, |c| = 1.
struct ScrewMotion {
  Vec3 c_bar = Vec3::Zero(), c = Vec3::UnitZ();

  Vec3 velocity(const Vec3& x) const { return c_bar + c.cross(x); }
  double rise() const { return c.dot(c_bar); }
  Vec3 axis_point() const { return c.cross(c_bar); }
};

/// The motion to which facets of given weights are most nearly tangent (a linear line complex in the sense of Pottmann
/// and Randrup, "Rotational and helical surface approximation for reverse engineering", Computing 60, 1998).
struct ScrewFit {
  bool found = false;
  ScrewMotion motion;
  double best = 0, second = 0;  ///< the two least mean squares, over the facets' mean square distance: 0.1 is much
};

/// Where a facet that is a chord of the motion has the motion's direction: the middle of its extent along it.
inline Vec3 chord_middle(const Facet& f, const ScrewMotion& m) {
  const Vec3 v = m.velocity(f.center);
  const double speed2 = v.squaredNorm();
  if (!(speed2 > 0)) return f.center;
  double lo = 0, hi = 0;
  for (const Vec3& x : f.corner) {
    const double t = (x - f.center).dot(v);
    lo = t < lo ? t : lo;
    hi = t > hi ? t : hi;
  }
  return f.center + 0.5 * (lo + hi) / speed2 * v;
}

/// Fits to the facets `of[i]` with `weight[i]`. Where a whole family fits, as for a cylinder of any rise, the one of
/// least velocity. Facets count at the middle of their chords about `near`, where one is known, else at their centers.
/// With `rise` the facet of[i] follows the motion with so much more rise.
ScrewFit fit_screw(const std::vector<Facet>& facets, const std::vector<std::size_t>& of,
                   const std::vector<double>& weight, const ScrewMotion* near = nullptr,
                   const std::vector<double>* rise = nullptr);

/// The same with the direction of `motion`, and without a rise.
ScrewMotion without_rise(const std::vector<Facet>& facets, const std::vector<std::size_t>& of,
                         const std::vector<double>& weight, const ScrewMotion& motion);

}  // namespace tegotae
