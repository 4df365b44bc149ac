#pragma once

#include <array>
#include <cstdint>

#include "narrowphase/free_cell.hpp"

namespace tegotae {

/// So many pieces of B are measured at once.
inline constexpr int kMeasured = 8;

/// All that a piece of A covers when it is shifted by up to `ahead`, in a frame of its own, by which pieces of B are
/// measured: the box's axes, or the triangle's plane and longest side.
struct HullFrame {
  HullFrame(const Hull& a, const Vec3& ahead);
  HullFrame() = default;

  Vec3 origin = Vec3::Zero();                     ///< the hull's middle on half of its way, B's axes
  std::array<Vec3, 3> axis;                       ///< B's axes, of unit length up to single precision
  std::array<double, 3> low{}, high{};            ///< extent along the axes, from the origin, m
  std::array<double, 3> way{};                    ///< half of `ahead` along the axes, m
  std::array<double, 3> half{};                   ///< extents of a box, m
  std::array<std::array<double, 3>, 3> corner{};  ///< of a triangle on half of its way, along the axes, m
  bool triangle = false;
};

/// Pieces of B, field after field: boxes or triangles, never both. Unused places may hold any finite numbers.
struct alignas(64) NearHulls {
  typedef std::array<double, kMeasured> Field;
  std::array<Field, 3> center;               ///< of boxes, from the origin of the frame, B's axes, m
  std::array<std::array<Field, 3>, 3> edge;  ///< axes of boxes; corners of triangles like the centers
  std::array<Field, 3> half;                 ///< of boxes, m
};

/// How far pieces of B are from the piece of A.
struct alignas(64) Nearness {
  typedef std::array<double, kMeasured> Field;
  /// The best of some normals.
  struct Side {
    Field gap;     ///< m; negative: they overlap
    Field number;  ///< 0 to 2: axes of the frame, from 3 on: axes of the box of B, or its plane
    Field sign;    ///< 1 or -1: with it the normal goes from B to A
  };
  Field distance2;             ///< square of a lower bound of the distance, m²
  Side any;                    ///< the best of the normals of both pieces' faces
  Side upright;                ///< the better of the normals of both pieces' surfaces, the faces of boxes that are thin
  std::array<Field, 3> plane;  ///< unit normals of triangles of B, zero where there is none
};

/// Up to rounding in double precision and what the axes are longer than one.
void measure_boxes(const HullFrame& a, const NearHulls& b, int count, Nearness& out) noexcept;
void measure_triangles(const HullFrame& a, const NearHulls& b, int count, Nearness& out) noexcept;

/// Planes that a cell has so far, field after field; those that are not there nothing is above.
struct alignas(64) KnownPlanes {
  typedef std::array<double, kCellPlanes> Field;
  std::array<Field, 3> n;
  Field low_start, low_end;  ///< of the piece of A at the two ends of the motion, along the normal, m
  Field top;                 ///< of the pieces of B below, m

  void clear();
};

/// The first of `count` planes over `b` with at least the asked gaps (m) at the two ends of the motion; kCellPlanes
/// when there is none. Sets the height of `b` along its normal in `tops`.
int first_above(const KnownPlanes& planes, int count, const Hull& b, double gap_start, double gap_end,
                std::array<double, kCellPlanes>& tops) noexcept;

}  // namespace tegotae
