#pragma once

#include <cstddef>

namespace tegotae {

/// Curved pairs that are checked at once.
inline constexpr std::size_t kCurvedLanes = 8;

/// What the gap of a curved pair needs of A's piece, about A's own axis.
enum CurvedField : std::size_t {
  kCurvedZLow,
  kCurvedZHigh,
  kCurvedR,      ///< middle of the range of r
  kCurvedRHalf,  ///< half of it
  kCurvedRLow,
  kCurvedRHigh,
  kCurvedInverse,     ///< 1 / r
  kCurvedInverseLow,  ///< 1 / r_lo
  kCurvedCos,         ///< of the azimuth
  kCurvedSin,
  kCurvedCosHalf,  ///< of half of the arc; of arcs that are too wide −1
  kCurvedSinHalf,
  kCurvedFields
};
/// And of a direction: α and β, and the gap along it of the pieces where they are.
enum CurvedSide : std::size_t { kSideAlpha, kSideBeta, kSideBase, kSideFields };

}  // namespace tegotae
