#include "contact/separating_axis.hpp"

#include <algorithm>

#include "feature/simplex_distance.hpp"

namespace tegotae {
namespace {

// Below this the cross product of two edges of unit length has no direction worth trusting.
constexpr double kMinCrossProduct = 1e-9;

}  // namespace

AxisLimit least_limiting_axis(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                              const std::array<Vec3, 3>& motion, double clearance) {
  AxisLimit best;
  double best_end = -1e300;
  const auto consider = [&](const Vec3& axis) {
    const double length = axis.norm();
    if (!(length > kMinCrossProduct)) return;
    for (const double sign : {1.0, -1.0}) {
      const Vec3 n = (sign / length) * axis;
      const double side_b = std::max({n.dot(b[0]), n.dot(b[1]), n.dot(b[2])});
      double start = 1e300, end = 1e300, gap = 0;
      int corner = 0;
      for (int i = 0; i < 3; ++i) {
        const double g = n.dot(a[i]) - side_b, e = g + n.dot(motion[i]);
        start = std::min(start, g);
        if (e < end) {
          end = e;
          corner = i;
          gap = g;
        }
      }
      if (start >= clearance && end > best_end) {
        best_end = end;
        best = {true, n, corner, gap};
      }
    }
  };
  const ClosestPoints c = closest_points({3, a}, {3, b});
  if (c.squared_distance > 0) consider((c.a - c.b) / std::sqrt(c.squared_distance));
  std::array<Vec3, 3> ea, eb;
  for (int i = 0; i < 3; ++i) {
    ea[i] = (a[(i + 1) % 3] - a[i]).normalized();
    eb[i] = (b[(i + 1) % 3] - b[i]).normalized();
  }
  consider(ea[0].cross(ea[1]));
  consider(eb[0].cross(eb[1]));
  for (const Vec3& u : ea)
    for (const Vec3& v : eb) consider(u.cross(v));
  return best;
}

}  // namespace tegotae
