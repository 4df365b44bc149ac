// Bodies made from random numbers with fixed seeds.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae::shapes {

inline Vec3 random_vector(std::mt19937& rng, double size) {
  std::uniform_real_distribution<double> u(-size, size);
  return {u(rng), u(rng), u(rng)};
}

inline Vec3 random_direction(std::mt19937& rng) {
  std::normal_distribution<double> g;
  Vec3 v(g(rng), g(rng), g(rng));
  return v.normalized();
}

/// Convex hull of points in general position by definition: a triple is a face when all others lie on one side. O(n⁴).
inline TriangleMesh convex_hull(const std::vector<Vec3>& points) {
  TriangleMesh mesh;
  mesh.vertices = points;
  const auto n = static_cast<std::uint32_t>(points.size());
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = i + 1; j < n; ++j)
      for (std::uint32_t k = j + 1; k < n; ++k) {
        const Vec3 normal = (points[j] - points[i]).cross(points[k] - points[i]);
        int above = 0, below = 0;
        for (std::uint32_t l = 0; l < n; ++l)
          if (l != i && l != j && l != k) (normal.dot(points[l] - points[i]) > 0 ? above : below)++;
        if (above == 0) mesh.triangles.push_back({i, j, k});
        if (below == 0) mesh.triangles.push_back({i, k, j});
      }
  return mesh;
}

/// A convex body whose vertices all lie on an ellipsoid-like shape of the given size (m).
inline TriangleMesh random_convex_body(std::mt19937& rng, int vertices, double size) {
  std::vector<Vec3> points;
  const Vec3 stretch = Vec3(1, 1, 1) + random_vector(rng, 0.4);
  for (int i = 0; i < vertices; ++i) points.push_back(size * stretch.cwiseProduct(random_direction(rng)));
  return convex_hull(points);
}

/// A closed body, not convex: the same as random_convex_body with each vertex pulled in or out along its ray.
inline TriangleMesh random_star_body(std::mt19937& rng, int vertices, double size) {
  TriangleMesh mesh = random_convex_body(rng, vertices, size);
  std::uniform_real_distribution<double> u(0.55, 1.0);
  for (Vec3& v : mesh.vertices) v *= u(rng);
  return mesh;
}

}  // namespace tegotae::shapes
