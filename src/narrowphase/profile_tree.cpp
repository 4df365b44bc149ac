#include "narrowphase/profile_tree.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace tegotae {
namespace {

/// Smaller patches are as flat as their triangles.
constexpr std::uint32_t kMinFaces = 4;

ProfileSum of_face(const PatchTree& tree, std::uint32_t face, const ScrewFrame& frame) {
  return profile_of(
      {frame.local(tree.corner(face, 0)), frame.local(tree.corner(face, 1)), frame.local(tree.corner(face, 2))},
      frame.rise);
}

}  // namespace

ProfileTree::ProfileTree(const PatchTree& tree, const ScrewFrame& frame) : frame_(frame) {
  const std::vector<PatchNode>& nodes = tree.nodes();
  place_.assign(nodes.size(), kNone);
  struct Step {
    std::uint32_t node;
    bool joins;  // its children lie on the stack of sums
  };
  struct Sum {
    ProfileSum bounds;
    std::uint32_t faces;
  };
  std::vector<Step> steps{{0, false}};
  std::vector<Sum> sums;
  while (!steps.empty()) {
    const Step step = steps.back();
    steps.pop_back();
    const PatchNode& n = nodes[step.node];
    if (!n.leaf() && !step.joins) {
      steps.push_back({step.node, true});
      steps.push_back({n.first, false});
      steps.push_back({n.first + 1, false});
      continue;
    }
    Sum sum;
    if (n.leaf()) {
      sum = {of_face(tree, tree.order()[n.first], frame), n.count};
      for (std::uint32_t k = 1; k < n.count; ++k)
        sum.bounds = joined(sum.bounds, of_face(tree, tree.order()[n.first + k], frame), frame.rise);
    } else {
      const Sum left = sums.back();
      sums.pop_back();
      const Sum right = sums.back();
      sums.pop_back();
      sum = {joined(left.bounds, right.bounds, frame.rise), left.faces + right.faces};
    }
    sums.push_back(sum);
    if (sum.faces < kMinFaces || !sum.bounds.usable()) continue;
    const ProfileBox box = rounded(sum.bounds, frame.rise);
    if (!box.usable()) continue;
    place_[step.node] = static_cast<std::uint32_t>(boxes_.size());
    boxes_.push_back(box);
  }
  boxes_.shrink_to_fit();
  measure();
}

ProfileTree::ProfileTree(const ScrewFrame& frame, std::vector<std::uint32_t> place, std::vector<ProfileBox> boxes)
    : frame_(frame), place_(std::move(place)), boxes_(std::move(boxes)) {
  measure();
}

void ProfileTree::measure() {
  if (boxes_.empty()) return;
  z_min_ = boxes_[0].z_lo;
  z_max_ = boxes_[0].z_hi;
  for (const ProfileBox& box : boxes_) {
    r_max_ = std::max<double>(r_max_, box.r_hi);
    z_min_ = std::min<double>(z_min_, box.z_lo);
    z_max_ = std::max<double>(z_max_, box.z_hi);
  }
}

}  // namespace tegotae
