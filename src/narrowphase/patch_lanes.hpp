#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>

namespace tegotae {

/// `x` or the next larger number of the precision.
template <typename Real>
Real round_up(double x) {
  return std::nextafter(static_cast<Real>(x), std::numeric_limits<Real>::infinity());
}

/// A motion for the wide check of a front (see Sweep): rotations row by row, m.
template <typename Real>
struct LaneMotion {
  std::array<Real, 9> R0, R1;
  std::array<Real, 3> t0, t1;
  Real bulge = 0;         ///< θ²/8, rounded up
  Real bulge_offset = 0;  ///< |center| θ²/8, rounded up
  Real error = 0;         ///< bound of the rounding of one gap, m
};

/// Single precision decides nearly all pairs; what it leaves within its rounding (0.4 µm for a 40 mm part, too much for
/// a part that rests at a gap of 1 to 2 µm) goes to double precision, sixteen at once as well.
struct LaneSweep {
  LaneMotion<float> coarse;
  LaneMotion<double> fine;
};

inline constexpr std::size_t kLanes = 16;

/// Blocks of kLanes front pairs, field after field: 16 boxes or triangles are checked at once.
class LaneBlocks {
 public:
  LaneBlocks(std::size_t capacity, std::size_t fields) : fields_(fields), blocks_((capacity + kLanes - 1) / kLanes) {
    const std::size_t bytes = blocks_ * kLanes * fields_ * sizeof(float);
    data_.reset(static_cast<float*>(std::aligned_alloc(kLanes * sizeof(float), bytes)));
    for (std::size_t i = 0; i < blocks_ * kLanes * fields_; ++i) data_.get()[i] = 0;
  }

  float& at(std::size_t slot, std::size_t field) {
    return data_.get()[((slot / kLanes) * fields_ + field) * kLanes + slot % kLanes];
  }
  float at(std::size_t slot, std::size_t field) const { return const_cast<LaneBlocks*>(this)->at(slot, field); }
  /// The block of `slot`, which is its first.
  const float* block(std::size_t slot) const { return data_.get() + slot * fields_; }
  void move(std::size_t from, std::size_t to) {
    for (std::size_t f = 0; f < fields_; ++f) at(to, f) = at(from, f);
  }

 private:
  struct Free {
    void operator()(float* p) const { std::free(p); }
  };
  std::size_t fields_, blocks_;
  std::unique_ptr<float, Free> data_;
};

/// Fields of a box pair: plane normal (B's axes), offset of B's support along it; of A's box, relative to the center of
/// mass and along A's axes: center, three half edges; largest distance of a point of it from the center of mass.
enum BoxField : std::size_t {
  kBoxNormal = 0,
  kBoxOffset = 3,
  kBoxCenter = 4,
  kBoxEdges = 7,
  kBoxReach = 16,
  kBoxFields
};
/// Fields of a triangle pair: the same (the plane stands at the same place), with three corners.
enum TriangleField : std::size_t { kTriNormal = 0, kTriOffset = 3, kTriCorners = 4, kTriReach = 13, kTriFields };

/// Which of the pairs from slot `first` (the first of a block) up to `end` do not certainly keep a positive gap to
/// their plane during the motion: their slots, in order, to `failed` (room for end - first); returns how many. The same
/// on every processor: the wide versions do the same operations in the same order, none fused.
std::size_t box_failures(const LaneBlocks& pairs, std::size_t first, std::size_t end, const LaneSweep& sweep,
                         std::uint32_t* failed);
std::size_t triangle_failures(const LaneBlocks& pairs, std::size_t first, std::size_t end, const LaneSweep& sweep,
                              std::uint32_t* failed);

}  // namespace tegotae
