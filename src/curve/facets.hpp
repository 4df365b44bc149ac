#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "curve/screw_fit.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

/// A mesh's triangles as facets, by place; of many the same sample whatever their order.
struct Facets {
  explicit Facets(const TriangleMesh& mesh);

  std::vector<Facet> all;
  Vec3 middle = Vec3::Zero();  ///< of the mesh's box, m
  double size = 0;             ///< half the diagonal of the box, m
  double area = 0;             ///< of all facets, in size²

 private:
  void add(const std::array<Vec3, 3>& corners);
};

}  // namespace tegotae
