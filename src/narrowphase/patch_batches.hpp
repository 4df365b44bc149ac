#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "narrowphase/near_hulls.hpp"
#include "narrowphase/patch_tree.hpp"

namespace tegotae {

/// As many pieces as are measured together, into which a node of a hierarchy is taken apart: nodes some levels below,
/// with their numbers field after field, or all of its faces.
struct PatchBatch {
  NearHulls boxes{};                            ///< of nodes
  std::array<std::uint32_t, kMeasured> item{};  ///< as in CellItems
  std::uint32_t count = 0;
  bool faces = false;
};

/// The batches of a hierarchy, made once for what a search that begins at the root comes to: some 20 bytes a triangle,
/// and 7 MB at most. Immutable.
class PatchBatches {
 public:
  explicit PatchBatches(const PatchTree& tree);

  /// Of any node of `tree`, which is that of the constructor; `made` is where it is made if it is not known.
  const PatchBatch& of(const PatchTree& tree, std::uint32_t node, PatchBatch& made) const {
    if (batch_[node] < batches_.size()) return batches_[batch_[node]];
    make(tree, node, made);
    return made;
  }
  std::size_t bytes() const;

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  void make(const PatchTree& tree, std::uint32_t node, PatchBatch& out) const;

  std::vector<std::uint32_t> faces_;  ///< of each node: how many
  std::vector<std::uint32_t> batch_;  ///< of each node, kNone where it is made when it is asked for
  std::vector<PatchBatch> batches_;
};

}  // namespace tegotae
