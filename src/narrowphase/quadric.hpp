#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "narrowphase/slab.hpp"

namespace tegotae {

/// A height over the first two axes of a slab, along the last one, which the faces in it follow: where they curve, they
/// are off it by a hundredth of the slab's thickness.
struct Quadric {
  double height;          ///< at the slab's center, m
  Eigen::Vector2d slope;  ///< there
  Eigen::Matrix2d bend;   ///< second derivatives, 1/m
  double off;             ///< no point of a face is farther from it along the last axis, m
};

/// Of the faces in a slab with these corners, three a face (m, from where its center is from). None where it would tell
/// little more than the slab, or is steep.
std::optional<Quadric> quadric_of(const std::vector<Vec3>& corners, const Slab& slab);

/// Those of the slabs of a SlabLanes, field after field.
struct alignas(64) QuadricLanes {
  typedef SlabLanes::Field Field;
  alignas(32) std::array<Field, 3> half;  ///< of the slab, m
  Field height, off;
  std::array<Field, 2> slope;
  std::array<Field, 3> bend;  ///< uu, uv, vv
  std::uint32_t fits = 0;     ///< a bit for each that there is; the others are flat, and as thick as the slab

  QuadricLanes(const Slab* slabs, const std::optional<Quadric>* quadrics, std::size_t count);
};

/// Of eight slabs, those from whose faces all in `a` are at least `floor` (m) away all along the motion, by their
/// heights over the quadrics of the eight: a bit each. The faces in `a` follow number `k` of `of_a`; `origin` is its
/// point. The rounding in single precision is taken off. For the others, `share` gets how much of the motion that holds
/// for, about.
std::uint32_t kept_apart_by_heights(const SlabEnds& a, const QuadricLanes& of_a, std::uint32_t k, const Vec3& origin,
                                    const SlabLanes& b, const QuadricLanes& of_b, double floor,
                                    QuadricLanes::Field& share) noexcept;

}  // namespace tegotae
