#pragma once

#include "tegotae/mesh/triangle_mesh.hpp"

/// Screws and nuts with an ISO metric thread (ISO 68-1: flanks of 60°, crests and roots cut flat), axis z, lengths in
/// m. Closed, facing outward. Impossible sizes throw tegotae::Error.
namespace tegotae::shapes {

struct Thread {
  double diameter = 0.016;  ///< nominal (major)
  double pitch = 0.002;     ///< from a crest to the next one; a turn rises by `starts` of them
  bool left_hand = false;
  int segments = 96;  ///< around, a multiple of 6
  int rows = 3;       ///< bands of triangles on a flank, 1 to 16
  int starts = 1;     ///< threads side by side, 1 to 8
};

/// A hexagon bolt: the thread from its tip at z = 0 up to the head, or to a shank of the thread's diameter.
struct Bolt {
  Thread thread;
  double length = 0.030;
  double chamfer = 0.001;  ///< at the tip, 45°
  double shank = 0;        ///< length below the head without a thread
  double runout = 0;       ///< length over which the thread's root rises to the shank
  double head_width = 0.024, head_height = 0.010;
};
/// Corners lie on the thread's surface, so the facets of the flanks lie below it.
TriangleMesh bolt(const Bolt& b);

/// A hexagon nut from z = 0 to z = `height`; it fits over a bolt of the same thread, both unturned, where its z is a
/// multiple of the pitch. `play` is what it can go up or down from there, flank to flank.
struct Nut {
  Thread thread;
  double height = 0.013;
  double width = 0.024;    ///< across flats
  double chamfer = 0.001;  ///< at both mouths, 45°
  double play = 1e-4;      ///< m, along the axis
};
TriangleMesh nut(const Nut& n);

}  // namespace tegotae::shapes
