#pragma once

#include "tegotae/mesh/triangle_mesh.hpp"

/// Spur gears with involute teeth. Impossible sizes throw tegotae::Error.
namespace tegotae::shapes {

/// Axis z from z = 0 up, a tooth's middle on the x axis. Two gears of the same module and pressure angle mesh at a
/// distance of module · (teeth + teeth) / 2, a tooth of one in a gap of the other.
struct Gear {
  double module = 0.002;                       ///< m; the pitch circle has the diameter module · teeth
  int teeth = 20;                              ///< at least 8
  double pressure_angle = 0.3490658503988659;  ///< rad
  double width = 0.01;                         ///< m, along the axis
  double bore = 0.008;                         ///< diameter of the hole, m
  double backlash = 5e-5;                      ///< what a tooth is thinner than half of its pitch, m
  int flank = 6;                               ///< facets of a flank
  int layers = 1;                              ///< bands along the axis
};
TriangleMesh gear(const Gear& g);

}  // namespace tegotae::shapes
