#pragma once

#include <functional>

#include "tegotae/mesh/triangle_mesh.hpp"

/// Surfaces over a rectangle about the origin of the xy plane, lengths in m. Impossible sizes throw tegotae::Error.
namespace tegotae::shapes {

/// z over x and y.
using Height = std::function<double(double x, double y)>;

/// The rectangle, and the cells along its sides; each cell is two triangles.
struct Grid {
  double size_x = 0.1, size_y = 0.1;
  int cells_x = 10, cells_y = 10;
};

/// An open sheet that faces up: `z` at the grid's corners.
TriangleMesh sheet(const Grid& grid, const Height& z);

/// The closed solid between `lower` and `upper`, which must be higher everywhere.
TriangleMesh slab(const Grid& grid, const Height& lower, const Height& upper);

/// Crossed waves: amplitude · sin(2π x / wave) · sin(2π y / wave).
Height waves(double amplitude, double wave);

}  // namespace tegotae::shapes
