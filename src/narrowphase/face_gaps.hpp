// How far faces are apart along directions, eight of them at once: to be compiled into what is compiled for several
// widths of registers itself.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "narrowphase/box_overlap.hpp"
#include "narrowphase/face_lanes.hpp"
#include "narrowphase/wide.hpp"

namespace tegotae {

/// Rounding of a gap in single precision, as a share of the sum of all coordinates that it comes from: two dozen
/// operations and numbers that were rounded, of 6e-8 each, along normals that are no axes.
inline constexpr float kGapError = 5e-6F;

/// Conditions on vectors longer than a register would go number by number.
inline constexpr std::uint32_t kLane = 8;
typedef float Lane __attribute__((vector_size(kLane * sizeof(float)), may_alias));
typedef EightBits LaneBits;
static_assert(kBlockFaces == 2 * kLane);

typedef std::array<float, 3> Float3;

struct Lanes3 {
  Lane x, y, z;
};

// No lambda gives a lane back: it would be compiled for other registers than its caller, unless it is inlined.

TEGOTAE_INLINE Lane load(const FaceLanes::Field& field, std::uint32_t first) {
  return *reinterpret_cast<const Lane*>(field.data() + first);
}
TEGOTAE_INLINE Lanes3 load3(const std::array<FaceLanes::Field, 3>& f, std::uint32_t first) {
  return {load(f[0], first), load(f[1], first), load(f[2], first)};
}
TEGOTAE_INLINE Lane lesser(Lane a, Lane b) {
  return a < b ? a : b;
}
TEGOTAE_INLINE Lane greater(Lane a, Lane b) {
  return a > b ? a : b;
}
TEGOTAE_INLINE Lane dot(const Lanes3& a, const Float3& b) {
  return a.x * b[0] + a.y * b[1] + a.z * b[2];
}

TEGOTAE_INLINE float dot(const Float3& a, const Float3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

TEGOTAE_INLINE float sum_of_sizes(const Float3& x) {
  return std::abs(x[0]) + std::abs(x[1]) + std::abs(x[2]);
}

/// Eight numbers, one a lane.
typedef std::array<float, kLane> EightFloats;

TEGOTAE_INLINE Lane all_of(const EightFloats& field) {
  return *reinterpret_cast<const Lane*>(field.data());
}
TEGOTAE_INLINE Lanes3 all_of(const std::array<EightFloats, 3>& f) {
  return {all_of(f[0]), all_of(f[1]), all_of(f[2])};
}
TEGOTAE_INLINE void store8(EightFloats& field, Lane x) {
  *reinterpret_cast<Lane*>(field.data()) = x;
}
TEGOTAE_INLINE Lane size_of(Lane x) {
  return greater(x, -x);
}

TEGOTAE_INLINE void store(FaceLanes::Field& field, std::uint32_t first, Lane x) {
  *reinterpret_cast<Lane*>(field.data() + first) = x;
}

TEGOTAE_INLINE void store3(std::array<FaceLanes::Field, 3>& f, std::uint32_t first, const Lanes3& x) {
  store(f[0], first, x.x);
  store(f[1], first, x.y);
  store(f[2], first, x.z);
}

/// One of the faces, as it is asked about.
struct OneFace {
  static constexpr std::size_t kCorners = 6;
  const MovedLanes& of;
  std::uint32_t k;

  TEGOTAE_INLINE float corner(std::size_t c, std::size_t i) const { return of.corner[c][i][k]; }
  TEGOTAE_INLINE float normal(std::size_t i) const { return of.normal[i][k]; }
  TEGOTAE_INLINE float normal_low() const { return of.normal_low[k]; }
  TEGOTAE_INLINE float normal_high() const { return of.normal_high[k]; }
  TEGOTAE_INLINE float low(std::size_t i) const { return of.low[i][k]; }
  TEGOTAE_INLINE float high(std::size_t i) const { return of.high[i][k]; }
};

struct OneBox {
  static constexpr std::size_t kCorners = 16;
  const MovedBox& of;

  TEGOTAE_INLINE float corner(std::size_t c, std::size_t i) const { return of.corner[c][i]; }
  TEGOTAE_INLINE float normal(std::size_t i) const { return of.normal[i]; }
  TEGOTAE_INLINE float normal_low() const { return of.normal_low; }
  TEGOTAE_INLINE float normal_high() const { return of.normal_high; }
  TEGOTAE_INLINE float low(std::size_t i) const { return of.low[i]; }
  TEGOTAE_INLINE float high(std::size_t i) const { return of.high[i]; }
};

/// The greatest of the gaps along the axes between `a` and eight faces of `b`.
template <typename One>
TEGOTAE_INLINE Lane axis_gaps(const One& a, const FaceLanes& b, std::uint32_t first, const Float3& shift) {
  Lane gap{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Lane p = load(b.corner[0][i], first), q = load(b.corner[1][i], first), r = load(b.corner[2][i], first);
    const Lane low = lesser(lesser(p, q), r), high = greater(greater(p, q), r);
    const Lane along = greater(low - (a.high(i) + shift[i]), (a.low(i) + shift[i]) - high);
    gap = i == 0 ? along : greater(gap, along);
  }
  return gap;
}

template <typename One>
TEGOTAE_INLINE Lane along_corner(const Lanes3& n, const One& a, std::size_t c) {
  return n.x * a.corner(c, 0) + n.y * a.corner(c, 1) + n.z * a.corner(c, 2);
}

/// The same along the normal of `a`.
template <typename One>
TEGOTAE_INLINE Lane gaps_from_plane(const One& a, const FaceLanes& b, std::uint32_t first, const Float3& shift) {
  const Float3 along = {a.normal(0), a.normal(1), a.normal(2)};
  const float up = along[0] * shift[0] + along[1] * shift[1] + along[2] * shift[2];
  const Lane p = dot(load3(b.corner[0], first), along), q = dot(load3(b.corner[1], first), along),
             r = dot(load3(b.corner[2], first), along);
  return greater((a.normal_low() + up) - greater(greater(p, q), r), lesser(lesser(p, q), r) - (a.normal_high() + up));
}

/// The same along the normals of `b`.
template <typename One>
TEGOTAE_INLINE Lane gaps_to_planes(const One& a, const FaceLanes& b, std::uint32_t first, const Float3& shift) {
  const Lanes3 n = load3(b.normal, first);
  Lane low = along_corner(n, a, 0), high = low;
  for (std::size_t c = 1; c < One::kCorners; ++c) {
    const Lane x = along_corner(n, a, c);
    low = lesser(low, x);
    high = greater(high, x);
  }
  const Lane moved = dot(n, shift);
  return greater(low + moved - load(b.normal_high, first), load(b.normal_low, first) - (high + moved));
}

/// A direction that may keep a face apart from others, and where the face is along it.
struct Along {
  Float3 n;
  float low, high;
};

template <typename One>
TEGOTAE_INLINE Along along(const Float3& n, const One& a) {
  Along out{n, 0, 0};
  for (std::size_t c = 0; c < One::kCorners; ++c) {
    const float x = n[0] * a.corner(c, 0) + n[1] * a.corner(c, 1) + n[2] * a.corner(c, 2);
    out.low = c == 0 ? x : std::min(out.low, x);
    out.high = c == 0 ? x : std::max(out.high, x);
  }
  return out;
}

/// The gap along it to eight faces of `b`.
TEGOTAE_INLINE Lane gaps_along(const Along& a, const FaceLanes& b, std::uint32_t first, const Float3& shift) {
  const float up = a.n[0] * shift[0] + a.n[1] * shift[1] + a.n[2] * shift[2];
  const Lane p = dot(load3(b.corner[0], first), a.n), q = dot(load3(b.corner[1], first), a.n),
             r = dot(load3(b.corner[2], first), a.n);
  return greater((a.low + up) - greater(greater(p, q), r), lesser(lesser(p, q), r) - (a.high + up));
}

/// Bits of sixteen conditions.
TEGOTAE_INLINE std::uint32_t bits_of(LaneBits one, LaneBits other) {
  return together((one & kEachBit) | (other & (kEachBit << kLane)));
}

/// A bit for each face of `b` that has less than `floor`. Planes keep most apart, and axes few more. Both halves go
/// together: one by one, as many branches would be guessed wrongly again.
template <typename One>
TEGOTAE_INLINE std::uint32_t gaps_below(const One& a, const Along& guess, const FaceLanes& b, const Float3& shift,
                                        float floor) {
  LaneBits one = (LaneBits)(gaps_from_plane(a, b, 0, shift) < floor),
           other = (LaneBits)(gaps_from_plane(a, b, kLane, shift) < floor);
  if (together(one | other) == 0) return 0;
  one &= (LaneBits)(gaps_to_planes(a, b, 0, shift) < floor);
  other &= (LaneBits)(gaps_to_planes(a, b, kLane, shift) < floor);
  if (together(one | other) == 0) return 0;
  one &= (LaneBits)(axis_gaps(a, b, 0, shift) < floor);
  other &= (LaneBits)(axis_gaps(a, b, kLane, shift) < floor);
  one &= (LaneBits)(gaps_along(guess, b, 0, shift) < floor);
  other &= (LaneBits)(gaps_along(guess, b, kLane, shift) < floor);
  return bits_of(one, other);
}

inline Float3 in_single(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// With room for the rounding of all that is asked about.
inline float floor_in_single(float size, const FaceLanes& b, const Vec3& shift, double floor) {
  return static_cast<float>(floor) + kGapError * (size + b.size + static_cast<float>(shift.cwiseAbs().maxCoeff()));
}

}  // namespace tegotae
