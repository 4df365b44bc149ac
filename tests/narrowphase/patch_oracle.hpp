// Independent checks of poses and motions: FCL finds candidate triangle pairs, signed volumes in extended precision
// decide.
#pragma once

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include "patch_shapes.hpp"

namespace tegotae::test {

using Real3 = Eigen::Matrix<long double, 3, 1>;
using Corners = std::array<Vec3, 3>;

/// Does the segment p q meet the triangle t? Touching counts.
inline bool segment_meets(const Real3& p, const Real3& q, const std::array<Real3, 3>& t) {
  auto volume = [](const Real3& a, const Real3& b, const Real3& c, const Real3& d) {
    return (b - a).cross(c - a).dot(d - a);
  };
  const long double sp = volume(t[0], t[1], t[2], p), sq = volume(t[0], t[1], t[2], q);
  if ((sp > 0 && sq > 0) || (sp < 0 && sq < 0) || sp == sq) return false;
  const long double a = volume(p, q, t[0], t[1]), b = volume(p, q, t[1], t[2]), c = volume(p, q, t[2], t[0]);
  return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

inline bool triangles_meet(const Corners& a, const Corners& b) {
  std::array<Real3, 3> p, q;
  for (int i = 0; i < 3; ++i) p[i] = a[i].cast<long double>(), q[i] = b[i].cast<long double>();
  for (int i = 0; i < 3; ++i) {
    if (segment_meets(p[i], p[(i + 1) % 3], q) || segment_meets(q[i], q[(i + 1) % 3], p)) return true;
  }
  return false;
}

class Oracle {
 public:
  Oracle(MeshPtr a, MeshPtr b) : a_(a), b_(b), fa_(model(*a)), fb_(model(*b)) {}

  /// Do triangles of A (its file frame at X_BA) and B meet?
  bool meet(const Pose& X_BA) const {
    fcl::CollisionRequest<double> request(1000, true);
    fcl::CollisionResult<double> result;
    fcl::collide<double>(fa_.get(), transform(X_BA), fb_.get(), fcl::Transform3<double>::Identity(), request, result);
    for (std::size_t i = 0; i < result.numContacts(); ++i) {
      const auto& c = result.getContact(i);
      if (triangles_meet(corners(*a_, c.b1, X_BA), corners(*b_, c.b2, Pose{}))) return true;
    }
    return false;
  }

  double distance(const Pose& X_BA) const {
    fcl::DistanceRequest<double> request;
    fcl::DistanceResult<double> result;
    return fcl::distance<double>(fa_.get(), transform(X_BA), fb_.get(), fcl::Transform3<double>::Identity(), request,
                                 result);
  }

  /// Least distance over n + 1 poses of the path.
  double path_distance(const Pose& X, const Vec3& center, const Displacement& d, int n) const {
    double least = 1e9;
    for (int i = 0; i <= n; ++i) least = std::min(least, distance(displaced(X, center, (1.0 * i / n) * d)));
    return least;
  }

  /// Number of n + 1 poses, on each of the two paths that a certificate speaks of, where triangles meet.
  int hits(const Pose& X, const Vec3& center, const Displacement& d, int n) const {
    const Pose end = displaced(X, center, d);
    int found = 0;
    for (int i = 0; i <= n; ++i) {
      const double s = 1.0 * i / n;
      Pose P = displaced(X, center, s * d);
      found += meet(P);
      P.p = X.p + s * (end.p - X.p);
      found += meet(P);
    }
    return found;
  }

 private:
  using Model = fcl::BVHModel<fcl::OBBRSS<double>>;
  static std::unique_ptr<Model> model(const TriangleMesh& m) {
    auto out = std::make_unique<Model>();
    out->beginModel();
    for (const auto& t : m.triangles) out->addTriangle(m.vertices[t[0]], m.vertices[t[1]], m.vertices[t[2]]);
    out->endModel();
    return out;
  }
  static fcl::Transform3<double> transform(const Pose& X) {
    fcl::Transform3<double> T = fcl::Transform3<double>::Identity();
    T.linear() = X.q.toRotationMatrix();
    T.translation() = X.p;
    return T;
  }
  static Corners corners(const TriangleMesh& m, std::intptr_t f, const Pose& X) {
    const auto& t = m.triangles[static_cast<std::size_t>(f)];
    return {X * m.vertices[t[0]], X * m.vertices[t[1]], X * m.vertices[t[2]]};
  }
  MeshPtr a_, b_;
  std::unique_ptr<Model> fa_, fb_;
};

}  // namespace tegotae::test
