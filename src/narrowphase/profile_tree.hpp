#pragma once

#include <cstdint>
#include <vector>

#include "curve/profile_box.hpp"
#include "narrowphase/patch_tree.hpp"

namespace tegotae {

/// Profile boxes of the nodes of a PatchTree about one axis, for those of some faces that do not meet it. Immutable.
class ProfileTree {
 public:
  /// About 1 µs a triangle. The tree must outlive this.
  ProfileTree(const PatchTree& tree, const ScrewFrame& frame);
  /// What an earlier build over the same tree about the same frame made (see axis_cache.hpp).
  ProfileTree(const ScrewFrame& frame, std::vector<std::uint32_t> place, std::vector<ProfileBox> boxes);

  static constexpr std::uint32_t kNone = 0xffffffffu;

  const ScrewFrame& frame() const { return frame_; }
  /// The box of a node, or null.
  const ProfileBox* box(std::uint32_t node) const { return place_[node] == kNone ? nullptr : &boxes_[place_[node]]; }
  std::size_t boxes() const { return boxes_.size(); }
  /// Of all boxes: largest distance from the axis, and the range along it, m.
  double r_max() const { return r_max_; }
  double z_min() const { return z_min_; }
  double z_max() const { return z_max_; }

  const std::vector<std::uint32_t>& places() const { return place_; }  ///< of each node in all_boxes(), or kNone
  const std::vector<ProfileBox>& all_boxes() const { return boxes_; }

 private:
  void measure();

  ScrewFrame frame_;
  std::vector<std::uint32_t> place_;  ///< of each node
  std::vector<ProfileBox> boxes_;
  double r_max_ = 0, z_min_ = 0, z_max_ = 0;
};

}  // namespace tegotae
