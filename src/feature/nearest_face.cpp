#include "feature/nearest_face.hpp"

#include <algorithm>
#include <vector>

namespace tegotae {
namespace {

/// Corners of a triangle that carry a point inside it.
constexpr unsigned kInside = 7;

}  // namespace

NearestFace::NearestFace(std::shared_ptr<const Surface> surface, std::shared_ptr<const PatchTree> tree)
    : surface_(std::move(surface)),
      tree_(std::move(tree)),
      regions_(std::make_shared<const std::vector<RegionRange>>(regions_under(*surface_, *tree_))) {}

std::vector<NearestFace::RegionRange> NearestFace::regions_under(const Surface& surface, const PatchTree& tree) {
  std::vector<RegionRange> out(tree.nodes().size());
  // Children come after their parents.
  for (std::size_t i = out.size(); i-- > 0;) {
    const PatchNode& node = tree.nodes()[i];
    RegionRange& range = out[i];
    const auto add = [&range](std::uint32_t first, std::uint32_t last) {
      range = {std::min(range.first, first), std::max(range.last, last)};
    };
    for (std::uint32_t k = 0; k < node.count; ++k)
      if (const std::uint32_t r = surface.regions.of_face[tree.order()[node.first + k]]; r != kNone) add(r, r);
    if (node.leaf()) continue;
    for (const std::uint32_t child : {node.first, node.first + 1}) add(out[child].first, out[child].last);
  }
  return out;
}

bool NearestFace::complete() const {
  std::vector<std::pair<std::uint32_t, std::size_t>> stack{{0, 1}};
  while (!stack.empty()) {
    const auto [i, depth] = stack.back();
    stack.pop_back();
    if (depth > kDeepest) return false;
    if (tree_->nodes()[i].leaf()) continue;
    stack.push_back({tree_->nodes()[i].first, depth + 1});
    stack.push_back({tree_->nodes()[i].first + 1, depth + 1});
  }
  return true;
}

void NearestFace::try_face(const Vec3& p, std::uint32_t face, NearFace& best) const noexcept {
  if (surface_->topology.face_normals[face].isZero(0)) return;  // collapsed: its corners belong to others too
  const ClosestPoints c =
      closest_points({1, {p}}, {3, {tree_->corner(face, 0), tree_->corner(face, 1), tree_->corner(face, 2)}});
  if (c.squared_distance < best.squared) best = {c.squared_distance, c.b, face, c.mask_b};
}

void NearestFace::find_in_region(const Vec3& p, std::uint32_t face, NearFace& best) const noexcept {
  const std::vector<std::uint32_t>& of_face = surface_->regions.of_face;
  const std::uint32_t region = of_face[face];
  if (region == kNone) return try_face(p, face, best);
  const auto wanted = [&of_face, region](std::uint32_t f) { return of_face[f] == region; };
  const auto enters = [this, region](std::uint32_t node) {
    return (*regions_)[node].first <= region && region <= (*regions_)[node].last;
  };
  // Nothing in a plane is nearer than what is straight below.
  const auto enough = [&wanted](const NearFace& at) { return at.mask == kInside && wanted(at.face); };
  find(p, best, wanted, enters, enough);
}

double NearestFace::squared_bound(const Vec3& p, const PatchNode& node) const noexcept {
  const Vec3 d = p - tree_->origin() - node.center_vec();
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double out = std::max(0.0, std::abs(d.dot(node.axis_vec(i))) - double{node.half[i]});
    sum += out * out;
  }
  return kBoxRounding * sum;
}

}  // namespace tegotae
