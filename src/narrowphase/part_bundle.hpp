#pragma once

#include <memory>
#include <vector>

#include "narrowphase/face_pair.hpp"
#include "narrowphase/patch_tree.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae {

/// Fixed parts as one, under one hierarchy: where A lies on many parts, a piece of it needs one cell and not one for
/// each of them.
class PartBundle {
 public:
  /// Of the `members` among the fixed parts, in the world.
  PartBundle(const std::vector<std::shared_ptr<const TriangleMesh>>& fixed, const std::vector<Pose>& poses,
             const std::vector<std::uint32_t>& members);

  const std::shared_ptr<const PatchTree>& tree() const { return tree_; }
  bool has(std::uint32_t part) const { return is_member_[part]; }
  /// The pair of a face of A and a face of the bundle as a pair with one of its parts.
  FacePair of_part(const FacePair& pair) const noexcept;

 private:
  std::vector<std::uint32_t> members_;
  std::vector<std::uint32_t> first_face_;  ///< of each member
  std::vector<bool> is_member_;            ///< of each fixed part
  std::shared_ptr<const PatchTree> tree_;
};

}  // namespace tegotae
