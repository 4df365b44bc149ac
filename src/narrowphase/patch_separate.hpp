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

/// Looks for a plane that keeps the box `a` of A, whose center is at `center_a` from A's center of mass, apart from the
/// box `b` of B all along the motion. `reach` is the largest distance of a point of A's box from the center of mass
/// (m). `spare` (m) asks for that much more at both ends. A gap along a face of A counts `worth_of_a` times what one
/// along a face of B does, where there is a choice. `plane` comes in as the last known one and, where the boxes are
/// apart, goes out as the one that keeps them so.
bool separate_boxes(const PatchNode& a, const Vec3& center_a, const PatchNode& b, const Sweep& sweep, double reach,
                    double spare, double worth_of_a, MovingPlane& plane);

/// The same for two triangles (`a` relative to the center of mass, `b` to the origin of B's tree), complete at the two
/// ends (all separating axes and the closest direction are tried); halves the time up to 4 times in between. `beside`
/// (null: none) is tried after `plane`: one that keeps triangles near these apart.
bool separate_triangles(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, const Sweep& sweep, double reach,
                        const MovingPlane* beside, MovingPlane& plane);

}  // namespace tegotae
