#include "narrowphase/profile_tree.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "core/parallel_for.hpp"

namespace tegotae {
namespace {

/// Smaller patches are as flat as their triangles.
constexpr std::uint32_t kMinFaces = 4;
/// Trees of more faces are built by several threads, a branch each; what comes out does not depend on their number.
constexpr std::size_t kWorthThreads = 10000, kBranches = 64;

ProfileSum of_face(const PatchTree& tree, std::uint32_t face, const ScrewFrame& frame) {
  return profile_of(
      {frame.local(tree.corner(face, 0)), frame.local(tree.corner(face, 1)), frame.local(tree.corner(face, 2))},
      frame.rise);
}

struct Sum {
  ProfileSum bounds;
  std::uint32_t faces = 0;
};

/// The boxes of what hangs under a node, and the sum over it.
struct Branch {
  std::vector<std::pair<std::uint32_t, ProfileBox>> boxes;
  Sum sum;
};

Sum of_leaf(const PatchTree& tree, const PatchNode& n, const ScrewFrame& frame) {
  Sum sum{of_face(tree, tree.order()[n.first], frame), n.count};
  for (std::uint32_t k = 1; k < n.count; ++k)
    sum.bounds = joined(sum.bounds, of_face(tree, tree.order()[n.first + k], frame), frame.rise);
  return sum;
}

Sum of_both(const Sum& left, const Sum& right, const ScrewFrame& frame) {
  return {joined(left.bounds, right.bounds, frame.rise), left.faces + right.faces};
}

void add_box(std::uint32_t node, const Sum& sum, const ScrewFrame& frame, Branch& branch) {
  if (sum.faces < kMinFaces || !sum.bounds.usable()) return;
  const ProfileBox box = rounded(sum.bounds, frame.rise);
  if (box.usable()) branch.boxes.emplace_back(node, box);
}

Branch branch_of(const PatchTree& tree, std::uint32_t root, const ScrewFrame& frame) {
  const std::vector<PatchNode>& nodes = tree.nodes();
  struct Step {
    std::uint32_t node;
    bool joins;  // its children lie on the stack of sums
  };
  Branch branch;
  std::vector<Step> steps{{root, false}};
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
    if (n.leaf()) {
      sums.push_back(of_leaf(tree, n, frame));
    } else {
      const Sum left = sums.back();
      sums.pop_back();
      sums.back() = of_both(left, sums.back(), frame);
    }
    add_box(step.node, sums.back(), frame, branch);
  }
  branch.sum = sums.back();
  return branch;
}

}  // namespace

ProfileTree::ProfileTree(const PatchTree& tree, const ScrewFrame& frame) : frame_(frame) {
  const std::vector<PatchNode>& nodes = tree.nodes();
  // The topmost nodes in the order of their levels, and below them the branches, which threads build for themselves.
  std::vector<std::uint32_t> top, roots{0};
  while (roots.size() < kBranches && tree.order().size() >= kWorthThreads) {
    std::vector<std::uint32_t> below;
    for (const std::uint32_t node : roots) {
      if (nodes[node].leaf()) {
        below.push_back(node);
        continue;
      }
      top.push_back(node);
      below.insert(below.end(), {nodes[node].first, nodes[node].first + 1});
    }
    roots = std::move(below);
  }
  std::vector<Branch> branches(roots.size() + 1);
  parallel_for(static_cast<int>(roots.size()), 0,
               [&](int i) {
                 const auto k = static_cast<std::size_t>(i);
                 branches[k] = branch_of(tree, roots[k], frame);
               },
               {});
  std::map<std::uint32_t, Sum> sums;
  for (std::size_t i = 0; i < roots.size(); ++i) sums[roots[i]] = branches[i].sum;
  for (auto node = top.rbegin(); node != top.rend(); ++node) {
    const std::uint32_t first = nodes[*node].first;
    const Sum& sum = sums[*node] = of_both(sums.at(first), sums.at(first + 1), frame);
    add_box(*node, sum, frame, branches.back());
  }
  place_.assign(nodes.size(), kNone);
  std::size_t count = 0;
  for (const Branch& branch : branches) count += branch.boxes.size();
  boxes_.reserve(count);
  for (const Branch& branch : branches) {
    for (const auto& [node, box] : branch.boxes) {
      place_[node] = static_cast<std::uint32_t>(boxes_.size());
      boxes_.push_back(box);
    }
  }
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
