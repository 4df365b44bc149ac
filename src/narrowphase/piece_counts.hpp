#pragma once

#include <vector>

#include "narrowphase/patch_tree.hpp"

namespace tegotae {

/// Of how many pieces a hierarchy makes up its surface when they may be so thick: the thinner, the more. Thicknesses
/// are sorted by their size up to a fifth. Immutable.
class PieceCounts {
 public:
  explicit PieceCounts(const PatchTree& tree);

  /// `half_thickness` in m. At least one, at most as many as the hierarchy has leaves.
  int at(double half_thickness) const noexcept;

 private:
  std::vector<int> up_to_;  ///< pieces, for each grade of thickness
};

}  // namespace tegotae
