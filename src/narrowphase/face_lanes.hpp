#pragma once

#include <array>
#include <cstdint>

#include "narrowphase/face_blocks.hpp"

namespace tegotae {

/// A block of B's faces, field after field, from a point near them (m, axes of B's tree). Places without a face repeat
/// the last one.
struct alignas(64) FaceLanes {
  typedef std::array<float, kBlockFaces> Field;
  std::array<std::array<Field, 3>, 3> corner;
  std::array<Field, 3> normal;     ///< of unit length up to single precision, zero where there is none
  Field normal_low, normal_high;   ///< of the face's own corners along it
  std::array<Field, 3> low, high;  ///< of the corners along the axes
  Vec3 origin;                     ///< from that of B's tree, m
  float size = 0;                  ///< largest coordinate, m

  FaceLanes() = default;
  FaceLanes(const PatchTree& tree, const FaceBlocks& blocks, std::uint32_t block);
};

/// What A's hull of some points is at the two ends of a motion, from a point near it (m, axes of B's tree).
template <std::size_t points>
struct MovedHull {
  std::array<std::array<float, 3>, 2 * points> corner;  ///< at the start, then at the end
  std::array<float, 3> normal;                          ///< of the first three at the start, as that of FaceLanes
  float normal_low, normal_high;                        ///< of all corners along it
  std::array<float, 3> low, high;                       ///< of them along the axes
  float size;                                           ///< largest coordinate, m

  MovedHull() = default;
  MovedHull(const std::array<Vec3, points>& start, const std::array<Vec3, points>& end, const Vec3& origin);
};
typedef MovedHull<3> MovedFace;
typedef MovedHull<8> MovedBox;

/// Of the faces of `b`, those that neither the axes nor the planes of the faces, or A's first one, keep `floor` (m) apart from `a` at
/// both ends of its motion, and with that on the straight ways between: a bit each. `shift` is the origin of `a` from
/// that of `b`, m. The rounding in single precision is taken off.
std::uint32_t not_kept_apart(const MovedFace& a, const FaceLanes& b, const Vec3& shift, double floor) noexcept;
std::uint32_t not_kept_apart(const MovedBox& a, const FaceLanes& b, const Vec3& shift, double floor) noexcept;

/// Whether a direction across two edges, or across an edge in the plane of its face, keeps face `k` of `b` apart in the
/// same way.
bool edges_keep_apart(const MovedFace& a, const FaceLanes& b, std::uint32_t k, const Vec3& shift,
                      double floor) noexcept;

}  // namespace tegotae
