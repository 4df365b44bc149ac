#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/prefetch.hpp"
#include "narrowphase/face_blocks.hpp"
#include "narrowphase/patch_separate.hpp"

namespace tegotae {

/// A block of B's faces, field after field, from a point near them (m, axes of B's tree). Places without a face repeat
/// the last one.
struct alignas(64) FaceLanes {
  typedef std::array<float, kBlockFaces> Field;
  Vec3 origin;                ///< from that of B's tree, m
  float size = 0;             ///< largest coordinate, m
  std::array<float, 3> mean;  ///< of the normals, likewise
  float mean_low, mean_high;  ///< of all corners along it
  alignas(64) std::array<std::array<Field, 3>, 3> corner;
  std::array<Field, 3> normal;    ///< of unit length up to single precision, zero where there is none
  Field normal_low, normal_high;  ///< of the face's own corners along it

  FaceLanes() = default;
  FaceLanes(const PatchTree& tree, const FaceBlocks& blocks, std::uint32_t block);

  /// Calls for what MovedLanes::set() and BesideFaces::set() read.
  void call_for() const noexcept { prefetch(this, offsetof(FaceLanes, normal_low)); }
};

/// A block of A's faces at the two ends of a motion, field after field, from a point near it (m, axes of B's tree).
struct alignas(64) MovedLanes {
  typedef FaceLanes::Field Field;
  std::array<std::array<Field, 3>, 6> corner;  ///< at the start, then at the end
  std::array<Field, 3> normal;                 ///< at the start, as that of FaceLanes
  Field normal_low, normal_high;               ///< of the six corners along it
  std::array<Field, 3> low, high;              ///< of them along the axes
  float size = 0;                              ///< largest coordinate, m
  std::array<float, 3> mean;                   ///< of the normals, likewise
  float mean_low, mean_high;                   ///< of all corners along it

  /// `start` and `end` bring the faces, from their own origin, to where they are from the common one.
  void set(const FaceLanes& faces, const Placement& start, const Placement& end) noexcept;
  /// About all faces but those in `skipped`, a bit each.
  AxisBox box_without(std::uint32_t skipped) const noexcept;
};

/// A box at the two ends of a motion, from a point near it (m, axes of B's tree).
struct MovedBox {
  std::array<std::array<float, 3>, 16> corner;  ///< at the start, then at the end
  std::array<float, 3> normal;                  ///< across one of its sides at the start
  float normal_low, normal_high;                ///< of all corners along it
  std::array<float, 3> low, high;               ///< of them along the axes
  float size;                                   ///< largest coordinate, m

  /// The first three of `start` are of one side.
  MovedBox(const std::array<Vec3, 8>& start, const std::array<Vec3, 8>& end);
};

/// Of the faces of `b`, those that neither the axes nor the planes of the two faces keep `floor` (m) apart from face
/// `k` of `a` at both ends of its motion, and with that on the straight ways between: a bit each. `shift` is the origin
/// of `a` from that of `b`, m. The rounding in single precision is taken off.
std::uint32_t not_kept_apart(const MovedLanes& a, std::uint32_t k, const FaceLanes& b, const Vec3& shift,
                             double floor) noexcept;
/// The same of a box; of its sides the one that has a normal.
std::uint32_t not_kept_apart(const MovedBox& a, const FaceLanes& b, const Vec3& shift, double floor) noexcept;

/// Whether a direction across two edges, or across an edge in the plane of its face, keeps face `k_b` of `b` apart from
/// face `k` of `a` in the same way. To `direction` then, of unit length.
bool edges_keep_apart(const MovedLanes& a, std::uint32_t k, const FaceLanes& b, std::uint32_t k_b, const Vec3& shift,
                      double floor, std::array<float, 3>& direction) noexcept;

}  // namespace tegotae
