// A box that a pen presses onto a floor, z up.
#pragma once

#include <memory>

#include "tegotae/loop/scene.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae::test {

inline constexpr double kBoxHalf = 0.01;   // m, half its edge
inline constexpr double kStartGap = 2e-4;  // m, from the box to the floor

inline TriangleMesh box(double half) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.vertices.push_back(half * Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

inline TriangleMesh floor_square(double half) {
  TriangleMesh mesh;
  mesh.vertices = {Vec3(-half, -half, 0), Vec3(half, -half, 0), Vec3(half, half, 0), Vec3(-half, half, 0)};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

inline Scene press_scene() {
  Scene scene;
  scene.parts.push_back({"floor", std::make_shared<TriangleMesh>(floor_square(0.5)), Pose{}, false});
  scene.parts.push_back({"box", std::make_shared<TriangleMesh>(box(kBoxHalf)),
                         Pose{Quat::Identity(), Vec3(0, 0, kBoxHalf + kStartGap)}, true});
  return scene;
}

}  // namespace tegotae::test
