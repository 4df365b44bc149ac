#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>

#include "curve/axis_motion.hpp"
#include "curve/curved_fields.hpp"
#include "curve/profile_box.hpp"

namespace tegotae {

/// A pair of pieces that is apart in profile coordinates is so along one direction, or, where B's piece repeats from
/// turn to turn, along one that has A beyond the copies up to `turns` and one that has it before all later ones.
struct CurvedChoice {
  struct Side {
    std::int8_t direction = 0;  ///< of profile_directions()
    std::int8_t sign = 1;       ///< 1: A lies beyond B along it; −1: before
  };
  std::array<Side, 2> side;
  double turns = 0;  ///< of the last copy of B that side[0] is about
};

/// Directions along which the two pieces (A's about its own axis, in the frame that `m` moves) keep more than `spare`
/// (m) beyond the floors of `m` all along the motion; nothing when there are none among those that are tried. Pieces
/// must be usable, and `m` too.
std::optional<CurvedChoice> separate_curved(const ProfileBox& a, const ProfileBox& b, const AxisMotion& m,
                                            double spare);

/// The least of the margins of a choice (m); the same numbers as the wide check gives.
double curved_margin(const ProfileBox& a, const ProfileBox& b, const AxisMotion& m, const CurvedChoice& choice);

/// Curved pairs of one pair of axes, field after field: kCurvedLanes are checked at once.
class CurvedBlocks {
 public:
  explicit CurvedBlocks(std::size_t capacity);

  void set(std::size_t slot, const ProfileBox& a, const ProfileBox& b, double rise, const CurvedChoice& choice);
  void move(std::size_t from, std::size_t to);
  /// From now on the pair fails every check until it is set anew.
  void spoil(std::size_t slot);
  const double* block(std::size_t slot) const { return data_.get() + slot / kCurvedLanes * kBlock; }

 private:
  static constexpr std::size_t kFields = kCurvedFields + 2 * kSideFields;
  static constexpr std::size_t kBlock = kFields * kCurvedLanes;
  double& at(std::size_t slot, std::size_t field) {
    return data_.get()[slot / kCurvedLanes * kBlock + field * kCurvedLanes + slot % kCurvedLanes];
  }

  struct Free {
    void operator()(double* p) const { std::free(p); }
  };
  std::unique_ptr<double, Free> data_;
};

/// Which of the pairs in slots 0 to `end` do not certainly stay apart: their slots, in order, to `failed` (room for
/// `end`); returns how many. In double precision throughout; the same on every processor.
std::size_t curved_failures(const CurvedBlocks& pairs, std::size_t end, const AxisMotion& m, std::uint32_t* failed);

}  // namespace tegotae
