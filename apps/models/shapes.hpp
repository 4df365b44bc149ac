#pragma once

#include <array>

#include "tegotae/mesh/triangle_mesh.hpp"

/// Procedural parts: closed, facing outward, without T-junctions, lengths in m. Impossible sizes throw tegotae::Error.
namespace tegotae::shapes {

/// A round peg with a chamfer at its tip.
struct Peg {
  double diameter = 0.0188;
  double length = 0.050;
  double chamfer = 0.0005;  ///< at the tip, 45°; 0 for none
  int segments = 64;        ///< around, at least 3
  int rings = 8;            ///< along
};

/// Axis z, frame at the center, tip at -length/2. The polygon is inscribed: its corners lie on the cylinder.
TriangleMesh peg(const Peg& p);

/// A block with a round hole from its top face.
struct Block {
  double hole_diameter = 0.020;
  double depth = 0.040;  ///< of a blind hole
  Vec3 size = {0.06, 0.06, 0.05};
  double chamfer = 0.001;  ///< at the top rim, 45°; 0 for none
  int segments = 64;       ///< around, a multiple of 8
  int rings = 8;           ///< along
  bool through = false;    ///< the hole goes through the block, `depth` is not used
};

/// Hole axis z, top face at z = 0, the block below. The polygon is circumscribed: its facets touch the cylinder, so a
/// peg of diameter d < hole_diameter keeps a radial clearance of at least (hole_diameter - d) / 2 anywhere.
TriangleMesh block_with_hole(const Block& b);

/// A box of the given size about the origin, its sides divided into `parts` along x, y and z (a plate, a wall, a cube).
TriangleMesh box(const Vec3& size, const std::array<int, 3>& parts = {1, 1, 1});

/// A cylinder about the origin, axis z, corners on the cylinder.
TriangleMesh cylinder(double diameter, double length, int segments, int rings = 1);

/// A sphere about the origin, corners on the sphere: `segments` around z, `rings` from pole to pole.
TriangleMesh sphere(double diameter, int segments, int rings);

/// A closed tube along a (p, q) torus knot.
struct Knot {
  int p = 2, q = 3;              ///< turns about z, turns about the torus' circle; coprime
  double radius = 0.04;          ///< of the torus' circle
  double tube_radius = 0.016;    ///< of the torus, on which the center line lies
  double thickness = 0.012;      ///< diameter of the tube around the center line
  int along = 256, around = 16;  ///< divisions: 2 · along · around triangles
};
TriangleMesh torus_knot(const Knot& k);

/// `mesh` moved by `d`.
TriangleMesh moved(TriangleMesh mesh, const Vec3& d);

}  // namespace tegotae::shapes
