// Bodies for tests, made from random numbers with fixed seeds.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "models/random_bodies.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae::test {

using shapes::convex_hull;
using shapes::random_convex_body;
using shapes::random_direction;
using shapes::random_star_body;
using shapes::random_vector;

inline Pose random_pose(std::mt19937& rng, double size) {
  return {rotation(3.1 * random_direction(rng)), random_vector(rng, size)};
}

/// A box centered on its frame, 12 triangles facing out.
inline TriangleMesh box(const Vec3& size) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(
        0.5 * Vec3((i & 1 ? 1 : -1) * size.x(), (i & 2 ? 1 : -1) * size.y(), (i & 4 ? 1 : -1) * size.z()));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// Of a closed mesh, m^3; negative when it is inside out.
inline double volume(const TriangleMesh& mesh) {
  double v = 0;
  for (const auto& t : mesh.triangles) v += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]])) / 6;
  return v;
}

/// Height of the lowest vertex of a body at `X`, m.
inline double lowest(const TriangleMesh& mesh, const Pose& X) {
  double z = std::numeric_limits<double>::infinity();
  for (const Vec3& v : mesh.vertices) z = std::min(z, (X * v).z());
  return z;
}

inline std::shared_ptr<const TriangleMesh> shared(TriangleMesh mesh) {
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

}  // namespace tegotae::test
