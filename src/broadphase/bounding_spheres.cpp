#include "broadphase/bounding_spheres.hpp"

#include <algorithm>
#include <cmath>

#include "broadphase/bounding_boxes.hpp"

namespace tegotae {

Sphere bounding_sphere(const TriangleMesh& mesh) {
  const Vec3 center = bounding_box(mesh).center;
  return {center, radius_about(mesh, center)};
}

double radius_about(const TriangleMesh& mesh, const Vec3& center) {
  double r2 = 0;
  for (const Vec3& v : mesh.vertices) r2 = std::max(r2, (v - center).squaredNorm());
  return std::sqrt(r2);
}

void BoundingSpheres::add(const Sphere& sphere_F, const Pose& X_WF) {
  const Vec3 c = X_WF * sphere_F.center;
  x_.push_back(c.x());
  y_.push_back(c.y());
  z_.push_back(c.z());
  r_.push_back(sphere_F.radius);
}

void BoundingSpheres::query(const Vec3& center_W, double radius, double distance,
                            std::vector<std::uint32_t>& near) const {
  near.clear();
  const double reach = radius + distance;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const double dx = x_[i] - center_W.x(), dy = y_[i] - center_W.y(), dz = z_[i] - center_W.z();
    const double sum = r_[i] + reach;
    if (dx * dx + dy * dy + dz * dz <= sum * sum) near.push_back(static_cast<std::uint32_t>(i));
  }
}

}  // namespace tegotae
