#include "feature/surface_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "feature/simplex_distance.hpp"

namespace tegotae {
namespace {

Simplex corners(const PatchTree& tree, std::uint32_t face) {
  return {3, {tree.corner(face, 0), tree.corner(face, 1), tree.corner(face, 2)}};
}

double gap_along(const Vec3& n, const Simplex& a, const Simplex& b) {
  return std::min({n.dot(a.p[0]), n.dot(a.p[1]), n.dot(a.p[2])}) -
         std::max({n.dot(b.p[0]), n.dot(b.p[1]), n.dot(b.p[2])});
}

/// Whether the segment from `p` to `q` goes through the triangle.
bool goes_through(const Vec3& p, const Vec3& q, const Simplex& t) {
  const Vec3 n = (t.p[1] - t.p[0]).cross(t.p[2] - t.p[0]);
  const double from = n.dot(p - t.p[0]), to = n.dot(q - t.p[0]);
  if ((from > 0) == (to > 0)) return false;
  const Vec3 at = p + from / (from - to) * (q - p);
  for (int k = 0; k < 3; ++k)
    if (n.dot((t.p[(k + 1) % 3] - t.p[k]).cross(at - t.p[k])) < 0) return false;
  return true;
}

bool cross(const Simplex& a, const Simplex& b) {
  for (int k = 0; k < 3; ++k)
    if (goes_through(a.p[k], a.p[(k + 1) % 3], b) || goes_through(b.p[k], b.p[(k + 1) % 3], a)) return true;
  return false;
}

/// Nearest points of two triangles, which may cross.
ClosestPoints nearest(const Simplex& a, const Simplex& b) {
  ClosestPoints points = closest_points(a, b);
  // Triangles that do not cross are as far apart along the line between their nearest points as these are.
  if (points.squared_distance > 0 && gap_along(points.a - points.b, a, b) <= 0 && cross(a, b))
    points.squared_distance = 0;
  return points;
}

}  // namespace

class SurfaceDistance::Query : public LeafQuery {
 public:
  Query(SurfaceDistance& of, const Pose& X_BA, NearestPoints& out) : of_(of), X_(X_BA), out_(out) {}

  /// Looks at one pair of triangles; returns a lower bound of their distance.
  double visit(const Simplex& a, std::uint32_t face_a, std::uint32_t face_b, Vec3& normal, double& bound) {
    const Simplex b = corners(of_.front_.b(), face_b);
    const double gap = gap_along(normal, a, b);
    if (gap >= bound - NearFront::kTolerance) return gap;
    const ClosestPoints points = nearest(a, b);
    const double distance = std::sqrt(points.squared_distance);
    if (distance > 0) normal = (points.a - points.b) / distance;
    if (distance < bound) {
      bound = distance;
      out_ = {distance, points.a, points.b};
      of_.face_a_ = face_a;
      of_.face_b_ = face_b;
    }
    return distance;
  }

  Simplex placed(std::uint32_t face) const {
    Simplex a = corners(of_.front_.a(), face);
    for (Vec3& p : a.p) p = X_ * p;
    return a;
  }

  double distance(const PatchNode& a, const PatchNode& b, Vec3& normal, double& bound) override {
    const auto &of_a = of_.front_.a().order(), &of_b = of_.front_.b().order();
    double least = std::numeric_limits<double>::infinity();
    Vec3 best = normal;
    for (std::uint32_t i = 0; i < a.count; ++i) {
      const Simplex triangle = placed(of_a[a.first + i]);
      for (std::uint32_t k = 0; k < b.count; ++k) {
        Vec3 between = normal;
        const double found = visit(triangle, of_a[a.first + i], of_b[b.first + k], between, bound);
        if (found >= least) continue;
        least = found;
        best = between;
      }
    }
    normal = best;
    return least;
  }

 private:
  SurfaceDistance& of_;
  const Pose X_;
  NearestPoints& out_;
};

bool SurfaceDistance::within(double limit, const Pose& X_BA, NearestPoints& out) {
  Query query(*this, X_BA, out);
  double bound = std::nextafter(limit, std::numeric_limits<double>::infinity());
  Vec3 none = Vec3::Zero();
  query.visit(query.placed(face_a_), face_a_, face_b_, none, bound);
  front_.query(X_BA, bound, query);
  return bound <= limit;
}

}  // namespace tegotae
