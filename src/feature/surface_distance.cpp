#include "feature/surface_distance.hpp"

#include <algorithm>
#include <cmath>

#include "core/numbers.hpp"
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

/// Places of corners along a direction.
struct Span {
  double low, high;
  Span(const Vec3& n, const PatchTree& tree, std::uint32_t face) {
    const double x = n.dot(tree.corner(face, 0)), y = n.dot(tree.corner(face, 1)), z = n.dot(tree.corner(face, 2));
    low = std::min({x, y, z});
    high = std::max({x, y, z});
  }
  Span(const Vec3& n, const Simplex& t) {
    const double x = n.dot(t.p[0]), y = n.dot(t.p[1]), z = n.dot(t.p[2]);
    low = std::min({x, y, z});
    high = std::max({x, y, z});
  }
};

/// The unit normal of a triangle; zero for one without area.
Vec3 normal_of(const Simplex& t) {
  const Vec3 n = (t.p[1] - t.p[0]).cross(t.p[2] - t.p[0]);
  const double length = n.norm();
  return length > 0 ? Vec3(n / length) : Vec3::Zero();
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
  Query(SurfaceDistance& of, const Pose& X_BA, NearestPoints& out)
      : of_(of), X_(X_BA), R_(X_BA.q.toRotationMatrix()), out_(out) {}

  /// Measures one pair of triangles and returns its distance.
  double measure(std::uint32_t face_a, std::uint32_t face_b, Vec3& normal, double& bound) {
    Simplex a = corners(of_.front_.a(), face_a);
    for (Vec3& p : a.p) p = X_ * p;
    const ClosestPoints points = nearest(a, corners(of_.front_.b(), face_b));
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

  double distance(const PatchNode& a, const PatchNode& b, Vec3& normal, double& bound) override {
    const auto &of_a = of_.front_.a().order(), &of_b = of_.front_.b().order();
    const Vec3 along = normal, along_in_a = R_.transpose() * normal;
    const double shift = along.dot(X_.p);
    std::array<double, kPatchLeaf> high{};
    for (std::uint32_t k = 0; k < b.count; ++k) high[k] = Span(along, of_.front_.b(), of_b[b.first + k]).high;
    double least = kInfinity;
    for (std::uint32_t i = 0; i < a.count; ++i) {
      const std::uint32_t face_a = of_a[a.first + i];
      const double low = Span(along_in_a, of_.front_.a(), face_a).low + shift;
      for (std::uint32_t k = 0; k < b.count; ++k) {
        const std::uint32_t face_b = of_b[b.first + k];
        Vec3 between = along;
        double found = low - high[k];
        if (found < bound - NearFront::kTolerance) found = look(face_a, face_b, between, bound);
        if (found >= least) continue;
        least = found;
        normal = between;
      }
    }
    return least;
  }

 private:
  /// A lower bound of a pair's distance, with the direction that it is of: most triangles are kept apart by the plane
  /// of one of them, which takes a tenth of the time that their distance takes.
  double look(std::uint32_t face_a, std::uint32_t face_b, Vec3& normal, double& bound) {
    const Simplex a = corners(of_.front_.a(), face_a), b = corners(of_.front_.b(), face_b);
    const Vec3 of_a = normal_of(a), in_b = R_ * of_a;
    if (apart(Span(of_a, a), Span(in_b, b), in_b, normal, bound)) return gap_;
    const Vec3 of_b = normal_of(b);
    if (apart(Span(R_.transpose() * of_b, a), Span(of_b, b), of_b, normal, bound)) return gap_;
    return measure(face_a, face_b, normal, bound);
  }

  /// Whether a direction keeps triangles that cover `a` and `b` of it at the bound; sets gap_ and `normal` then.
  bool apart(const Span& a, const Span& b, const Vec3& direction, Vec3& normal, double bound) {
    const double shift = direction.dot(X_.p), above = a.low + shift - b.high, below = b.low - a.high - shift;
    gap_ = std::max(above, below);
    if (gap_ < bound - NearFront::kTolerance) return false;
    normal = above > below ? direction : Vec3(-direction);
    return true;
  }

  SurfaceDistance& of_;
  const Pose X_;
  const Mat3 R_;
  NearestPoints& out_;
  double gap_ = 0;
};

bool SurfaceDistance::within(double limit, const Pose& X_BA, NearestPoints& out) {
  Query query(*this, X_BA, out);
  double bound = std::nextafter(limit, kInfinity);
  Vec3 none = Vec3::Zero();
  query.measure(face_a_, face_b_, none, bound);
  front_.query(X_BA, bound, query);
  return bound <= limit;
}

}  // namespace tegotae
