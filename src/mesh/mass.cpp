#include "tegotae/mesh/mass.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>

namespace tegotae {
namespace {

/// Smallest trusted ratio of the volume to that of the bounding box; below it the integral is a difference of rounding
/// errors (a sheet folded onto itself, a double-sided surface).
constexpr double kSmallestFill = 1e-9;
/// Smallest trusted ratio of the inertia's eigenvalues; slimmer than any part, and still invertible without loss.
constexpr double kSmallestInertiaRatio = 1e-9;

struct BoundingBox {
  Vec3 min = Vec3::Zero(), max = Vec3::Zero();
};

BoundingBox box_of(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return {};
  BoundingBox box{mesh.vertices[0], mesh.vertices[0]};
  for (const Vec3& p : mesh.vertices) {
    box.min = box.min.cwiseMin(p);
    box.max = box.max.cwiseMax(p);
  }
  return box;
}

MassProperties solid_box(const TriangleMesh& mesh, const BoundingBox& box, double density) {
  constexpr double kThinnest = 0.01;  // of the largest side
  Vec3 size = box.max - box.min;
  size = size.cwiseMax(Vec3::Constant(kThinnest * size.maxCoeff()));

  Vec3 moment = Vec3::Zero();
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double twice = (b - a).cross(c - a).norm();
    moment += twice / 3 * (a + b + c);
    area += twice;
  }
  MassProperties out;
  out.mass = density * size.prod();
  out.center = area > 0 ? Vec3(moment / area) : Vec3(0.5 * (box.min + box.max));
  out.center = out.center.cwiseMax(box.min).cwiseMin(box.max);
  const Vec3 s = size.cwiseAbs2();
  out.inertia = (out.mass / 12 * Vec3(s.y() + s.z(), s.z() + s.x(), s.x() + s.y())).asDiagonal();
  return out;
}

}  // namespace

MassProperties mass_properties(const TriangleMesh& mesh, bool closed, double density) {
  const BoundingBox box = box_of(mesh);
  if (!closed) return solid_box(mesh, box, density);

  // Sum over the tetrahedra from the box's center, which keeps the terms small: with corners 0, a, b, c and
  // d = det(a, b, c), the volume is d / 6, the first moment d / 24 (a + b + c), the second moment
  // d / 120 (s sᵀ + a aᵀ + b bᵀ + c cᵀ) with s = a + b + c.
  const Vec3 origin = 0.5 * (box.min + box.max);
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - origin, b = mesh.vertices[t[1]] - origin, c = mesh.vertices[t[2]] - origin;
    const double d = a.dot(b.cross(c));
    const Vec3 s = a + b + c;
    volume += d / 6;
    first += d / 24 * s;
    second += d / 120 * (s * s.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  if (volume < 0) {  // inside out
    volume = -volume;
    first = -first;
    second = -second;
  }
  if (!(volume > kSmallestFill * (box.max - box.min).prod())) return solid_box(mesh, box, density);

  MassProperties out;
  out.from_volume = true;
  out.mass = density * volume;
  const Vec3 center = first / volume;
  out.center = origin + center;
  const Mat3 covariance = density * (second - volume * center * center.transpose());
  out.inertia = covariance.trace() * Mat3::Identity() - covariance;
  const Vec3 eigenvalues = Eigen::SelfAdjointEigenSolver<Mat3>(out.inertia, Eigen::EigenvaluesOnly).eigenvalues();
  if (!(eigenvalues.minCoeff() > kSmallestInertiaRatio * eigenvalues.maxCoeff())) {
    return solid_box(mesh, box, density);
  }
  return out;
}

double radius_of_gyration(const MassProperties& mass) noexcept {
  return std::sqrt(mass.inertia.trace() / (3 * mass.mass));
}

}  // namespace tegotae
