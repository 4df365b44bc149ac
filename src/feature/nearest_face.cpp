#include "feature/nearest_face.hpp"

#include <algorithm>
#include <vector>

namespace tegotae {
namespace {

/// Corners of a triangle that carry a point inside it.
constexpr unsigned kInside = 7;

struct Ancestry {
  std::vector<std::uint32_t> parent, depth;  ///< of each node
  std::vector<std::uint32_t> leaf;           ///< of each place in PatchTree::order()

  explicit Ancestry(const PatchTree& tree)
      : parent(tree.nodes().size(), 0), depth(tree.nodes().size(), 0), leaf(tree.order().size()) {
    for (std::uint32_t i = 0; i < tree.nodes().size(); ++i) {
      const PatchNode& node = tree.nodes()[i];
      for (std::uint32_t k = 0; k < node.count; ++k) leaf[node.first + k] = i;
      if (node.leaf()) continue;
      for (const std::uint32_t child : {node.first, node.first + 1}) parent[child] = i, depth[child] = depth[i] + 1;
    }
  }

  std::uint32_t common(std::uint32_t a, std::uint32_t b) const {
    while (a != b) (depth[a] < depth[b] ? b : a) = parent[depth[a] < depth[b] ? b : a];
    return a;
  }
};

/// Faces under a node are a range of PatchTree::order(), so a region's first and last places say what they are under.
std::vector<std::uint32_t> region_roots(const Surface& surface, const PatchTree& tree) {
  struct Places {
    std::uint32_t first = kNone, last = 0;
  };
  std::vector<Places> places(surface.regions.corner_begin.size() - 1);
  for (std::uint32_t i = 0; i < tree.order().size(); ++i) {
    const std::uint32_t region = surface.regions.of_face[tree.order()[i]];
    if (region == kNone) continue;
    places[region].first = std::min(places[region].first, i);
    places[region].last = i;
  }
  const Ancestry ancestry(tree);
  std::vector<std::uint32_t> roots;
  for (const Places& p : places)
    roots.push_back(p.first == kNone ? 0 : ancestry.common(ancestry.leaf[p.first], ancestry.leaf[p.last]));
  return roots;
}

}  // namespace

NearestFace::NearestFace(std::shared_ptr<const Surface> surface, std::shared_ptr<const PatchTree> tree)
    : surface_(std::move(surface)),
      tree_(std::move(tree)),
      region_roots_(std::make_shared<const std::vector<std::uint32_t>>(region_roots(*surface_, *tree_))) {}

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
  // Nothing in a plane is nearer than what is straight below.
  find_under((*region_roots_)[region], p, best, wanted, [](const NearFace& at) { return at.mask == kInside; });
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
