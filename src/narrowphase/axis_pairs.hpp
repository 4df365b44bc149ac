#pragma once

#include <memory>
#include <vector>

#include "narrowphase/curved_pairs.hpp"
#include "narrowphase/patch_tree.hpp"

namespace tegotae {

/// The axis pairs of a held part with fixed parts. Axes and profiles are built once for each mesh, and shared with all
/// others that use them now.
class AxisPairing {
 public:
  explicit AxisPairing(std::shared_ptr<const PatchTree> held);
  ~AxisPairing();

  /// Axes of one rise, or of rises that are one but for the error of finding them; both profiles are then taken with
  /// B's. At most kMaxAxisPairs, those of most surface first. Allocates. They live as long as this.
  const std::vector<AxisPair>* with(const std::shared_ptr<const PatchTree>& b);

 private:
  struct Known;
  std::unique_ptr<Known> known_;
};

}  // namespace tegotae
