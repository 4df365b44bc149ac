#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae::shapes {

using Ring = std::vector<std::uint32_t>;

/// Collects rings of vertices and the bands between them.
class MeshBuilder {
 public:
  explicit MeshBuilder(std::string name) { mesh_.name = std::move(name); }

  std::uint32_t vertex(const Vec3& p) {
    mesh_.vertices.push_back(p);
    return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
  }
  /// A regular polygon of corner radius `r` at height `z`, counter-clockwise from above.
  Ring ring(double r, double z, int segments) {
    Ring out;
    for (int i = 0; i < segments; ++i) {
      const double angle = 2 * 3.14159265358979323846 * i / segments;
      out.push_back(vertex({r * std::cos(angle), r * std::sin(angle), z}));
    }
    return out;
  }
  void face(std::uint32_t a, std::uint32_t b, std::uint32_t c) { mesh_.triangles.push_back({a, b, c}); }
  /// The band from `a` to `b`, facing right of the direction a -> b as seen along the ring.
  void band(const Ring& a, const Ring& b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      const std::size_t j = (i + 1) % a.size();
      face(a[i], a[j], b[j]);
      face(a[i], b[j], b[i]);
    }
  }
  /// The disk of `a` around the vertex `center`, counter-clockwise where `a` is.
  void disk(const Ring& a, std::uint32_t center) {
    for (std::size_t i = 0; i < a.size(); ++i) face(a[i], a[(i + 1) % a.size()], center);
  }
  TriangleMesh take() { return std::move(mesh_); }

 private:
  TriangleMesh mesh_;
};

}  // namespace tegotae::shapes
