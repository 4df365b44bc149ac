#pragma once

#include <cstdint>
#include <vector>

#include "tegotae/core/pose.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

/// A sphere around all vertices of a mesh, in its file frame (m).
struct Sphere {
  Vec3 center = Vec3::Zero();
  double radius = 0;
};

/// Sphere about the center of the bounding box.
Sphere bounding_sphere(const TriangleMesh& mesh);
/// Radius (m) of the smallest sphere about `center` (file frame) that holds every vertex.
double radius_about(const TriangleMesh& mesh, const Vec3& center);

/// Broad phase: the bounding spheres of all fixed parts, in the world.
class BoundingSpheres {
 public:
  /// Adds a part; parts are numbered in the order they come.
  void add(const Sphere& sphere_F, const Pose& X_WF);
  /// Parts whose sphere comes within `distance` of a ball, in ascending order. `near` keeps its capacity.
  void query(const Vec3& center_W, double radius, double distance, std::vector<std::uint32_t>& near) const;
  std::size_t size() const { return x_.size(); }

 private:
  std::vector<double> x_, y_, z_, r_;
};

}  // namespace tegotae
