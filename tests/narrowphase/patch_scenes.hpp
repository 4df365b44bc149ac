// Pairs of parts and motions for the tests of the path certificates.
#pragma once

#include <algorithm>

#include "narrowphase/patch_tree.hpp"
#include "patch_shapes.hpp"

namespace tegotae::test {

struct Scene {
  const char* name;
  MeshPtr a, b;
  Vec3 center;
  Pose start;
  double move, turn;  ///< m, rad
};

inline std::vector<Scene> scenes() {
  std::mt19937 rng(5);
  return {
      {"knots", knot(0.05, 0.006, 800), knot(0.05, 0.006, 900), Vec3(0.01, 0, 0.005),
       Pose{rotation(Vec3(0.3, 0.2, 0.1)), Vec3(0.13, 0, 0)}, 0.01, 0.3},
      {"peg in hole", peg(0.0098, 0.04, 600), hole(0.01, 0.04, 700), Vec3(0, 0, 0.02),
       Pose{Quat::Identity(), Vec3(0, 0, -0.02)}, 0.0005, 0.01},
      {"soups", soup(rng, 150, 0.05, 0.01), soup(rng, 150, 0.05, 0.01), Vec3::Zero(),
       Pose{Quat::Identity(), Vec3(0.11, 0, 0)}, 0.01, 0.5},
      {"box on a plate", box({0.02, 0.015, 0.01}), box({0.1, 0.1, 0.001}), Vec3::Zero(),
       Pose{Quat::Identity(), Vec3(0, 0, 0.02)}, 0.01, 0.3},
      {"offset file frame", box({0.02, 0.015, 0.01}), knot(0.05, 0.006, 800), Vec3(0.15, 0.1, 0),
       Pose{Quat::Identity(), Vec3(-0.08, 0, 0)}, 0.01, 0.3},
  };
}

/// Faces of the tree under a node, or the face itself.
inline std::vector<std::uint32_t> faces_under(const PatchTree& t, std::uint32_t node, bool is_face) {
  if (is_face) return {node};
  std::vector<std::uint32_t> out, stack{node};
  while (!stack.empty()) {
    const PatchNode& n = t.nodes()[stack.back()];
    stack.pop_back();
    if (n.leaf()) {
      out.insert(out.end(), t.order().begin() + n.first, t.order().begin() + n.first + n.count);
    } else {
      stack.push_back(n.first);
      stack.push_back(n.first + 1);
    }
  }
  return out;
}

/// Is every pair of faces of A and B under exactly one of the pairs that `for_each` calls its argument with, as
/// f(a, a_is_face, b, b_is_face)?
template <typename ForEach>
bool covers_once(const PatchTree& a, const PatchTree& b, ForEach for_each) {
  const std::size_t nb = b.order().size();
  std::vector<std::uint8_t> count(a.order().size() * nb, 0);
  for_each([&](std::uint32_t i, bool face_i, std::uint32_t j, bool face_j) {
    const auto fb = faces_under(b, j, face_j);
    for (const std::uint32_t f : faces_under(a, i, face_i))
      for (const std::uint32_t g : fb) ++count[f * nb + g];
  });
  return std::all_of(count.begin(), count.end(), [](std::uint8_t n) { return n == 1; });
}

/// Open sheet of n × n fields over a square of side `size`, with waves of `height` both ways, as eggs are packed in.
inline MeshPtr wave(double size, double height, double length, int n) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->name = "wave";
  for (int i = 0; i <= n; ++i) {
    for (int k = 0; k <= n; ++k) {
      const double x = size * (1.0 * i / n - 0.5), y = size * (1.0 * k / n - 0.5);
      mesh->vertices.emplace_back(x, y, height * std::sin(2 * kPi * x / length) * std::sin(2 * kPi * y / length));
    }
  }
  const auto at = [n](int i, int k) { return static_cast<std::uint32_t>(i * (n + 1) + k); };
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      mesh->triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh->triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  }
  return mesh;
}

}  // namespace tegotae::test
