#pragma once

#include <vector>

#include "curve/facets.hpp"
#include "curve/screw_fit.hpp"

namespace tegotae {

/// How far a facet's normal may be from square to a motion (rad) beyond what its own width explains.
inline constexpr double kAxisTolerance = 0.02;
/// The same at the middle of its chord, for what follows a motion closely.
inline constexpr double kSharpTolerance = 0.004;

/// How much of a surface follows a motion. Shares are of its area; of facets those that are `free` count, and no ends.
class AxisJudge {
 public:
  /// Both must outlive this.
  AxisJudge(const Facets& facets, const std::vector<char>& free) : facets_(facets), free_(free) {}

  /// Within `tolerance` (rad), by every `stride`-th facet.
  double share_within(const ScrewMotion& motion, double tolerance, std::size_t stride) const;
  /// Within kSharpTolerance at the middle of the chords.
  double share_at(const ScrewMotion& motion) const;
  /// Within four tolerances, without what turns about the axis: the cone beside a flank leans by the thread's rise from
  /// it, and is not chance.
  double share_beside(const ScrewMotion& motion) const;
  /// Whether the facets `of` look to enough sides of the axis.
  bool turns(const std::vector<std::size_t>& of, const ScrewMotion& motion) const;

 private:
  const Facets& facets_;
  const std::vector<char>& free_;
};

}  // namespace tegotae
