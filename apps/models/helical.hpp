#pragma once

#include "tegotae/mesh/triangle_mesh.hpp"

/// Threads and bent tubes, lengths in m. Impossible sizes throw tegotae::Error.
namespace tegotae::shapes {

/// A right-handed thread about z whose flanks are waves: r = radius + depth / 2 · cos(2π (z / pitch − angle / 2π)).
struct WavyThread {
  double radius = 0.008;  ///< mean
  double depth = 0.0012;
  double pitch = 0.003;
  double low = -0.006, high = 0;  ///< its ends along z
  int segments = 48;              ///< around
  int rings = 12;                 ///< along a pitch
};

/// A headless screw: the inside of the thread.
TriangleMesh screw(const WavyThread& t);
/// A round nut of outer radius `outside` around the thread.
TriangleMesh nut(const WavyThread& t, double outside);

/// A round bar of radius `radius` bent about the y axis: its center line runs at `bend` from the axis, from the angle
/// `from` to `to` (rad, from x towards z).
struct BentBar {
  double bend = 0.03, radius = 0.004;
  double from = 0, to = 1.4;
  int along = 32, around = 24;
};
TriangleMesh bent_bar(const BentBar& b);
/// A pipe bent like that, with a bore of `radius` and a wall.
TriangleMesh bent_pipe(const BentBar& bore, double wall);

}  // namespace tegotae::shapes
