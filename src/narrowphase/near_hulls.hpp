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

  Vec3 origin = Vec3::Zero();                    ///< the hull's middle on half of its way, B's axes
  std::array<float, 3> coarse{}, fine{};         ///< the same in two numbers of single precision, m
  std::array<Vec3, 3> axis;                      ///< B's axes, of unit length up to single precision
  std::array<std::array<float, 3>, 3> row{};     ///< the same in single precision
  std::array<float, 3> low{}, high{};            ///< extent along the axes, from the origin, m
  std::array<float, 3> way{};                    ///< half of `ahead` along the axes, m
  std::array<float, 3> half{};                   ///< extents of a box, m
  std::array<std::array<float, 3>, 3> corner{};  ///< of a triangle on half of its way, along the axes, m
  float size = 0;                                ///< sum of the extents, m
  bool triangle = false;
};

/// Pieces of B, field after field: boxes or triangles, never both. Unused places may hold any finite numbers.
struct alignas(64) NearHulls {
  typedef std::array<float, kMeasured> Field;
  std::array<Field, 3> center;               ///< of boxes, m, B's axes
  std::array<std::array<Field, 3>, 3> edge;  ///< axes of boxes; corners of triangles, from the frame's origin
  std::array<Field, 3> half;                 ///< of boxes, m
};

/// How far pieces of B are from the piece of A.
struct alignas(64) Nearness {
  typedef std::array<float, kMeasured> Field;
  /// The best of some normals.
  struct Side {
    Field gap;     ///< m, up to single precision; negative: they overlap
    Field normal;  ///< 1 to 3: axes of the frame, from 4 on: axes of the box of B, or its plane; negative: turned about
                   ///< so that it goes from B to A
  };
  Field distance;  ///< lower bound, rounding in single precision taken off, m
  Side any;        ///< the best of the normals of both pieces' faces
  Side upright;    ///< the better of the normals of both pieces' surfaces, the faces of boxes that are thin
};

void measure_boxes(const HullFrame& a, const NearHulls& b, Nearness& out) noexcept;
void measure_triangles(const HullFrame& a, const NearHulls& b, Nearness& out) noexcept;

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
