#pragma once

#include <array>

#include "narrowphase/patch_tree.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae {

/// Where A stands relative to B: the point r (A's axes, relative to A's center of mass) is at R r + t (B's axes,
/// relative to the origin of B's tree).
struct Placement {
  Mat3 R;
  Vec3 t;
};

/// A rigid motion of A past B, s in [0, 1]. Two paths are meant at once: the center of mass moving linearly, and the
/// origin of A's file frame moving linearly (as a reader of a recording interpolates), both turning at a constant rate.
struct Sweep {
  Sweep() = default;
  /// The motion of A's file frame from `X_BA` (in B's) by `d` (B's axes) of its center of mass `center` (m, file
  /// frame). `reach_a` (m) bounds A's points about that center; separations below `clearance` (m) do not count.
  Sweep(const Pose& X_BA, const Displacement& d, const Vec3& center, const PatchTree& b, double reach_a,
        double clearance);

  Placement start, end;
  Vec3 dp = Vec3::Zero();      ///< of the center of mass, m
  Vec3 dr = Vec3::Zero();      ///< rotation vector, rad
  double theta = 0;            ///< |dr|
  double theta2 = 0;           ///< its square
  Vec3 axis = Vec3::Zero();    ///< dr / |dr|, zero without a rotation
  double center_distance = 0;  ///< from the file frame's origin to the center of mass, m
  double floor = 0;            ///< separations below do not count: clearance, at least the rounding, m
  double start_floor = 0;  ///< the same at the start: less by the rounding with which the last motion kept the floor

  Placement at(double s) const;
};

/// A plane that moves: unit normals (B's axes, from B to A) at the start and the end of a motion.
struct MovingPlane {
  Vec3 n0, n1;
  bool with_a = false;  ///< it turned with A, and a plane that goes on to do so will last longest
};

/// A triangle of A at the two ends of a motion and a triangle of B.
struct TrianglePair {
  std::array<Vec3, 3> p0, p1;  ///< A's corners
  std::array<Vec3, 3> q;       ///< B's corners

  TrianglePair(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, const Placement& from, const Placement& to);

  double start(const Vec3& n) const;
  double end(const Vec3& n) const;
  double mixed(const Vec3& n0, const Vec3& n1) const;
};

/// A box of A and a box of B; the boxes outlive it.
struct BoxPair {
  const PatchNode& a;
  const PatchNode& b;
  Vec3 center_a;       ///< of A's box, from A's center of mass, A's axes, m
  double reach;        ///< largest distance of a point of A's box from the center of mass, m
  MovingPlane plane;   ///< in: the last known one; out: one that keeps the boxes apart, where there is one
  bool apart = false;  ///< out
};

/// Looks for planes that keep two pairs of boxes apart all along the motion; both take about as long as one (which may
/// be given twice). `spare` (m) asks for that much more at both ends. A gap along a face of A counts `worth_of_a` times
/// what one along a face of B does, where there is a choice.
void separate_boxes(BoxPair& one, BoxPair& two, const Sweep& sweep, double spare, double worth_of_a);

/// Looks for a plane that keeps two triangles apart (`a` relative to the center of mass, `b` to the origin of B's
/// tree), complete at the two ends (all separating axes and the closest direction are tried); halves the time up to 4
/// times in between. `reach` is that of a BoxPair, `plane` comes in as the last known one and goes out as the one that
/// keeps them apart. `beside` (null: none) is tried after it: one that keeps triangles near these apart.
bool separate_triangles(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, const Sweep& sweep, double reach,
                        const MovingPlane* beside, MovingPlane& plane);

}  // namespace tegotae
